#include "segmentation/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

// Radii of an ellipse as long as a ventricle: what a tracker smooths again in every frame.
Eigen::RowVectorXd ventricle() {
  Eigen::RowVectorXd radii(128);
  for (Eigen::Index k = 0; k < radii.size(); ++k) {
    const double angle = 2.0 * M_PI * static_cast<double>(k) / 128.0;
    radii(k) = 1.0 / std::hypot(std::cos(angle) / 42.0, std::sin(angle) / 80.0);
  }
  return radii;
}

TEST(outline, smoothing_frame_after_frame_keeps_the_apex) {
  const Eigen::RowVectorXd start = ventricle();
  Eigen::MatrixXd kept = start, shrunk = start;
  for (int frame = 0; frame < 30; ++frame) {
    kept = smooth_keeping_bends(kept, 3.0);
    shrunk = smooth_closed(shrunk, 3.0);
  }
  EXPECT_GT(kept.maxCoeff(), 0.93 * start.maxCoeff());
  EXPECT_LT(shrunk.maxCoeff(), 0.85 * start.maxCoeff());
}

TEST(outline, smoothing_that_keeps_bends_still_takes_off_noise) {
  Eigen::RowVectorXd rough = ventricle();
  for (Eigen::Index k = 0; k < rough.size(); ++k) rough(k) += k % 2 == 0 ? 1.0 : -1.0;
  const Eigen::MatrixXd smooth = smooth_keeping_bends(rough, 3.0);
  EXPECT_LT((smooth - smooth_keeping_bends(ventricle(), 3.0)).cwiseAbs().maxCoeff(), 1e-2);
}

}  // namespace
}  // namespace tissue_stiffness
