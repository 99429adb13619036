# Libraries without a CMake package of their own, and the two that carry a strong copyleft licence.

if(TISSUE_STIFFNESS_TETGEN)
  find_path(TETGEN_INCLUDE_DIR tetgen.h REQUIRED)
  find_library(TETGEN_LIBRARY NAMES tet REQUIRED)
  set(TETGEN_LIBRARIES ${TETGEN_LIBRARY})
  set_source_files_properties(src/meshing/tetgen_mesher.cpp PROPERTIES
    COMPILE_DEFINITIONS TISSUE_STIFFNESS_TETGEN)
endif()

find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(OPENBLAS_LIBRARY NAMES openblas PATH_SUFFIXES openblas-pthread)
add_library(cholmod_solver INTERFACE)
target_include_directories(cholmod_solver SYSTEM INTERFACE ${CHOLMOD_INCLUDE_DIR})
target_link_libraries(cholmod_solver INTERFACE ${CHOLMOD_LIBRARY})
if(OPENBLAS_LIBRARY)
  # Reference BLAS makes CHOLMOD several times slower.
  target_link_libraries(cholmod_solver INTERFACE ${OPENBLAS_LIBRARY})
else()
  message(WARNING "OpenBLAS not found: CHOLMOD will run on the system's default BLAS")
endif()
if(TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL)
  target_compile_definitions(cholmod_solver INTERFACE TISSUE_STIFFNESS_CHOLMOD_SUPERNODAL)
endif()

# Ubuntu 20.04's yaml-cpp and TBB packages lack the targets that newer ones have.
if(NOT TARGET TBB::tbb)
  add_library(TBB::tbb INTERFACE IMPORTED)
  target_link_libraries(TBB::tbb INTERFACE tbb)
endif()

if(NOT CLI11_FOUND)
  find_path(CLI11_INCLUDE_DIR CLI/CLI.hpp REQUIRED)
endif()
