# The Python package beside the messages of the same name, where pybind11 is. catkin wants to know of it before the messages.
option(TISSUE_STIFFNESS_PYTHON "Build `import tissue_stiffness` for Python" ON)

set(tissue_stiffness_python FALSE)
if(TISSUE_STIFFNESS_PYTHON AND NOT tissue_stiffness_sanitized AND NOT TISSUE_STIFFNESS_FUZZ)  # Python loads no sanitizer
  # catkin's Python, by both of the ways in which a pybind11 looks for it
  set(Python3_EXECUTABLE ${PYTHON_EXECUTABLE})
  set(PYBIND11_PYTHON_VERSION "${PYTHON_VERSION_MAJOR}.${PYTHON_VERSION_MINOR}")
  find_package(Python3 QUIET COMPONENTS Interpreter Development)
  find_package(pybind11 QUIET)
  if(pybind11_FOUND)
    set(tissue_stiffness_python TRUE)
    if(TISSUE_STIFFNESS_ROS)
      catkin_python_setup()
    else()
      tissue_stiffness_python_sources()
    endif()
  else()
    message(STATUS "pybind11 not found: no Python package; scripts/install_dependencies installs it")
  endif()
endif()
