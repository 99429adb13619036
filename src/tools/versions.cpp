#include "tools/versions.hpp"

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

namespace tissue_stiffness {

std::vector<std::pair<std::string, std::string>> versions() {
  const auto joined = [](int a, int b, int c) {
    return std::to_string(a) + "." + std::to_string(b) + "." + std::to_string(c);
  };
  return {{"tissue_stiffness", TISSUE_STIFFNESS_VERSION},
          {"compiler", __VERSION__},
          {"Eigen", joined(EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION)},
          {"OpenCV", CV_VERSION}};
}

}  // namespace tissue_stiffness
