#pragma once

#include <Eigen/Core>

namespace tissue_stiffness {

/// Residuals up to this many scales keep their full weight: 1 normal row in 2000 is beyond.
constexpr double robust_core = 3.5;

/// Weight of each row, for noise sigma / sqrt(weight). `standardised`: innovation / its standard deviation, NaN where there
/// is none (weight 1). Groups of `group` successive rows (the coordinates of one point) share the weight of their rms.
///
/// weight = 1 for r <= c s, (c s / r)^2 beyond: Huber's core with the tail of Student's t, so that the pull of a gross
/// outlier falls as 1/r. The scale s is the median of r over its median for normal noise (a MAD about zero), never below 1:
/// a few outliers do not move it, while a misfit of most of the body raises it and keeps its weight - what the model lacks
/// must stay visible.
Eigen::VectorXd robust_weights(const Eigen::VectorXd& standardised, int group = 1);

}  // namespace tissue_stiffness
