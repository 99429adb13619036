# tissue_stiffness_layer(NAME [LAYERS above...] [LIBRARIES ...] [INCLUDES ...] [ROS])
# One static library a folder of src/. Headers-only layers become interface libraries.
set(tissue_stiffness_core_targets)   # without ROS
set(tissue_stiffness_layer_targets)  # with ROS
set(tissue_stiffness_executable_targets)
set(tissue_stiffness_warnings -Wall -Wextra -Wconversion -Werror)

macro(tissue_stiffness_layer name)
  cmake_parse_arguments(LAYER "ROS" "" "LAYERS;LIBRARIES;INCLUDES" ${ARGN})
  set(target ${PROJECT_NAME}_${name})
  file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${name}/*.cpp)
  list(FILTER sources EXCLUDE REGEX "_main\\.cpp$")
  if(sources)
    set(scope PUBLIC)
    add_library(${target} STATIC ${sources})
    target_compile_options(${target} PRIVATE ${tissue_stiffness_warnings})
  else()
    set(scope INTERFACE)
    add_library(${target} INTERFACE)
  endif()
  # Public headers are in include, the others beside their sources; only the first are installed.
  target_include_directories(${target} ${scope} $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/src> $<INSTALL_INTERFACE:${CATKIN_GLOBAL_INCLUDE_DESTINATION}>)
  target_include_directories(${target} SYSTEM ${scope} ${LAYER_INCLUDES})
  foreach(above ${LAYER_LAYERS})
    target_link_libraries(${target} ${scope} ${PROJECT_NAME}_${above})
  endforeach()
  target_link_libraries(${target} ${scope} ${LAYER_LIBRARIES})
  if(LAYER_ROS)
    target_include_directories(${target} SYSTEM ${scope} ${catkin_INCLUDE_DIRS})
    target_link_libraries(${target} ${scope} ${catkin_LIBRARIES})
    add_dependencies(${target} ${PROJECT_NAME}_generate_messages_cpp ${catkin_EXPORTED_TARGETS})
    list(APPEND tissue_stiffness_layer_targets ${target})
  else()
    set_target_properties(${target} PROPERTIES EXPORT_NAME ${name})
    list(APPEND tissue_stiffness_core_targets ${target})
  endif()
endmacro()

macro(tissue_stiffness_executables layer)
  file(GLOB mains CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/src/${layer}/*_main.cpp)
  foreach(main ${mains})
    get_filename_component(name ${main} NAME_WE)
    string(REGEX REPLACE "_main$" "" name ${name})
    add_executable(${name} ${main})
    target_compile_options(${name} PRIVATE ${tissue_stiffness_warnings})
    target_link_libraries(${name} PRIVATE ${PROJECT_NAME}_${layer})
    list(APPEND tissue_stiffness_executable_targets ${name})
  endforeach()
endmacro()

# Tools that write what they know when they are interrupted, also while their libraries are being loaded.
macro(tissue_stiffness_start_with_signals_held)
  foreach(tool ${ARGN})
    set_target_properties(${tool} PROPERTIES OUTPUT_NAME ${tool}.tool)
    add_executable(start_${tool} ${PROJECT_SOURCE_DIR}/src/tools/start/start.cpp)
    set_target_properties(start_${tool} PROPERTIES OUTPUT_NAME ${tool})
    target_compile_options(start_${tool} PRIVATE ${tissue_stiffness_warnings})
    target_link_options(start_${tool} PRIVATE -Wl,--as-needed)
    if(TISSUE_STIFFNESS_SANITIZE)  # a sanitizer's library would take time to load too
      target_compile_options(start_${tool} PRIVATE -fno-sanitize=all)
      target_link_options(start_${tool} PRIVATE -fno-sanitize=all)
    endif()
    add_dependencies(${tool} start_${tool})
    list(APPEND tissue_stiffness_executable_targets start_${tool})
  endforeach()
endmacro()

# Template, style, scripts and libraries of report.html, compiled into the report layer.
macro(tissue_stiffness_report_assets)
  set(assets ${CMAKE_CURRENT_BINARY_DIR}/report_assets.cpp)
  file(GLOB_RECURSE asset_files CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/resources/report/*)
  add_custom_command(OUTPUT ${assets}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${assets} -DFOLDER=${PROJECT_SOURCE_DIR}/resources/report
      -P ${PROJECT_SOURCE_DIR}/cmake/embed.cmake
    DEPENDS ${asset_files} ${PROJECT_SOURCE_DIR}/cmake/embed.cmake)
  target_sources(${PROJECT_NAME}_report PRIVATE ${assets})
endmacro()
