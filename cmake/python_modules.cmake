# The compiled modules of the Python package: `_core` has no ROS, and `_bag`, which reads rosbags, is loaded for them alone.
macro(tissue_stiffness_python_module name)
  cmake_parse_arguments(PYTHON "" "" "SOURCES;LAYERS" ${ARGN})
  set(target ${PROJECT_NAME}_python${name})
  add_library(${target} MODULE ${PYTHON_SOURCES})
  target_link_libraries(${target} PRIVATE pybind11::module)
  target_compile_options(${target} PRIVATE ${tissue_stiffness_warnings})
  target_link_options(${target} PRIVATE -Wl,--exclude-libs,ALL)  # what is linked in is nobody else's
  foreach(layer ${PYTHON_LAYERS})
    target_link_libraries(${target} PRIVATE ${PROJECT_NAME}_${layer})
  endforeach()
  set_target_properties(${target} PROPERTIES PREFIX "" OUTPUT_NAME ${name} CXX_VISIBILITY_PRESET hidden
    LIBRARY_OUTPUT_DIRECTORY ${CATKIN_DEVEL_PREFIX}/${CATKIN_PACKAGE_PYTHON_DESTINATION})
  install(TARGETS ${target} LIBRARY DESTINATION ${CATKIN_PACKAGE_PYTHON_DESTINATION})
endmacro()

if(tissue_stiffness_python)
  file(GLOB python_sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/python/*.cpp)
  list(FILTER python_sources EXCLUDE REGEX "/bag_module\\.cpp$")
  tissue_stiffness_python_module(_core SOURCES ${python_sources} LAYERS diagnosis report vtu)
  if(TISSUE_STIFFNESS_ROS)
    tissue_stiffness_python_module(_bag SOURCES ${PROJECT_SOURCE_DIR}/src/python/bag_module.cpp LAYERS tools)
  endif()
endif()
