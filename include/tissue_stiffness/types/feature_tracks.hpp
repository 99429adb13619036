#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Where features of the body's surface are in one image, and where they were in the reference image, which shows the body
/// at rest. Pixel coordinates are those of Contour. All arrays have one entry a feature.
struct FeatureTracks {
  double stamp = 0.0;          ///< time of the image [s]
  int width = 0;               ///< image size [pixel]
  int height = 0;              ///< image size [pixel]
  Eigen::VectorXi ids;         ///< the same number is the same feature in every image
  Eigen::Matrix2Xd pixels;     ///< (u, v) in this image [pixel]
  Eigen::Matrix2Xd reference;  ///< (u, v) in the reference image [pixel]
  Eigen::VectorXd sigma;       ///< 1-sigma uncertainty of each coordinate [pixel]
  Eigen::VectorXd windows;     ///< half the edge of the square around `reference` that was compared; 0: a point [pixel]
  Eigen::VectorXi facets;      ///< of the mesh at rest, which carries the feature; empty until it is placed there

  Eigen::Index size() const { return pixels.cols(); }
  bool empty() const { return pixels.cols() == 0; }
};

}  // namespace tissue_stiffness
