# Libraries without a CMake package of their own, and the two that carry a strong copyleft licence.

# find_path and find_library know REQUIRED since CMake 3.18 only.
function(tissue_stiffness_require)
  foreach(found ${ARGN})
    if(NOT ${found})
      message(FATAL_ERROR "${found}: not found; scripts/install_dependencies installs what is missing")
    endif()
  endforeach()
endfunction()

if(TISSUE_STIFFNESS_TETGEN)
  find_path(TETGEN_INCLUDE_DIR tetgen.h)
  find_library(TETGEN_LIBRARY NAMES tet)
  tissue_stiffness_require(TETGEN_INCLUDE_DIR TETGEN_LIBRARY)
  set(TETGEN_LIBRARIES ${TETGEN_LIBRARY})
  set_source_files_properties(src/meshing/tetgen_mesher.cpp PROPERTIES
    COMPILE_DEFINITIONS TISSUE_STIFFNESS_TETGEN)
endif()

find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse)
find_library(CHOLMOD_LIBRARY cholmod)
tissue_stiffness_require(CHOLMOD_INCLUDE_DIR CHOLMOD_LIBRARY)
find_library(OPENBLAS_LIBRARY NAMES openblas PATH_SUFFIXES openblas-pthread)
if(NOT OPENBLAS_LIBRARY)
  # Reference BLAS makes CHOLMOD several times slower.
  message(WARNING "OpenBLAS not found: CHOLMOD will run on the system's default BLAS")
  set(OPENBLAS_LIBRARY "")
endif()
find_library(LAPACK_LIBRARY lapack)  # OpenBLAS has it, too, and comes first
tissue_stiffness_require(LAPACK_LIBRARY)
if(TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL)
  set_source_files_properties(src/fem/sparse_solver.cpp PROPERTIES
    COMPILE_DEFINITIONS TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL)
endif()

# TBB of 2020 may come without a CMake package.
find_path(TBB_INCLUDE_DIR tbb/parallel_for.h)
find_library(TBB_LIBRARY tbb)
tissue_stiffness_require(TBB_INCLUDE_DIR TBB_LIBRARY)

# For those who link the core through catkin, which hands on files and no targets.
find_library(YAML_CPP_LIBRARY yaml-cpp)
tissue_stiffness_require(YAML_CPP_LIBRARY)
set(SOLVERS_FOUND TRUE)
set(SOLVERS_INCLUDE_DIRS ${CHOLMOD_INCLUDE_DIR})
set(SOLVERS_LIBRARIES ${CHOLMOD_LIBRARY} ${OPENBLAS_LIBRARY} ${LAPACK_LIBRARY} ${TBB_LIBRARY} ${TETGEN_LIBRARIES} ${YAML_CPP_LIBRARY})
