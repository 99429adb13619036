#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Outline of the tissue in one image. Pixel coordinates follow OpenCV: (0, 0) is the centre of the upper left pixel, u
/// points to the right, and v points down.
struct Contour {
  double stamp = 0.0;        ///< time of the image [s]
  int width = 0;             ///< image size [pixel]
  int height = 0;            ///< image size [pixel]
  bool closed = true;        ///< the last point is joined to the first
  Eigen::Matrix2Xd points;   ///< (u, v), ordered along the outline [pixel]
  Eigen::Matrix2Xd normals;  ///< unit vectors that point out of the body (silhouette) or out of the cavity (cavity)
  Eigen::VectorXd sigma;     ///< 1-sigma uncertainty along the normal [pixel]; infinity where the edge was not seen

  Eigen::Index size() const { return points.cols(); }
  bool empty() const { return points.cols() == 0; }
};

}  // namespace tissue_stiffness
