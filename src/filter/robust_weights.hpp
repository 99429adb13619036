#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Residuals up to this many scales keep their full weight. 1 normal row in 2000 is beyond.
constexpr double robust_core = 3.5;

/// Returns the weight of each row, which then has the noise sigma / sqrt(weight). `standardised`: innovation over its
/// standard deviation, NaN where there is none (weight 1). Groups of `group` successive rows (the coordinates of one point)
/// share the weight of their rms.
///
/// The weight is 1 for r <= c s, and (c s / r)^2 beyond. This is Huber's core with the tail of Student's t, so that the
/// influence of a gross outlier falls as 1/r. The scale s is the median of r over its median for normal noise (a MAD about
/// zero), and at least 1. A few outliers do not change it. A misfit of most of the body raises it and so keeps its weight,
/// because what the model lacks must stay visible.
Eigen::VectorXd robust_weights(const Eigen::VectorXd& standardised, int group = 1);

}  // namespace tissue_stiffness
