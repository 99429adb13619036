# Headers of other projects that most sources include, parsed once: the sources include what they use all the same, and
# scripts/tidy builds without. Each group has one owner; GCC takes a precompiled header only from a target of equal options.
option(TISSUE_STIFFNESS_PRECOMPILED_HEADERS "Parse the headers of other projects once" ON)

set(tissue_stiffness_core_headers
  <algorithm> <array> <cmath> <functional> <map> <memory> <optional> <sstream> <stdexcept> <string> <vector>
  <Eigen/Core> <Eigen/Cholesky> <Eigen/Geometry> <Eigen/QR> <Eigen/SVD> <Eigen/Sparse>)
set(tissue_stiffness_ros_headers ${tissue_stiffness_core_headers}
  <ros/ros.h> <geometry_msgs/PoseStamped.h> <geometry_msgs/WrenchStamped.h> <sensor_msgs/CameraInfo.h> <sensor_msgs/Image.h>
  <sensor_msgs/PointCloud2.h>)
set(tissue_stiffness_tool_headers ${tissue_stiffness_core_headers} <iostream> <ros/ros.h>)
set(tissue_stiffness_test_headers ${tissue_stiffness_core_headers} <gtest/gtest.h>)

# tissue_stiffness_precompile(TARGET core|ros|tool|test): the group's first target is its owner.
macro(tissue_stiffness_precompile target group)
  if(TISSUE_STIFFNESS_PRECOMPILED_HEADERS)
    if(NOT tissue_stiffness_${group}_headers_owner)
      set(tissue_stiffness_${group}_headers_owner ${target})
      target_precompile_headers(${target} PRIVATE ${tissue_stiffness_${group}_headers})
    else()
      target_precompile_headers(${target} REUSE_FROM ${tissue_stiffness_${group}_headers_owner})
    endif()
    if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
      # ccache asks for the first; the second is what some targets get from PCL's own, and all of a group must have.
      target_compile_options(${target} PRIVATE -fpch-preprocess -fPIC)
    endif()
  endif()
endmacro()
