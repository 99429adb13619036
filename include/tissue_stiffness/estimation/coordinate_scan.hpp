#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace tissue_stiffness {

/// Where a cost was found lowest.
struct ScanResult {
  Eigen::VectorXd best;
  Eigen::VectorXd step;  ///< distance between the points looked at, along each coordinate; 0 where none was better
  double lowest = 0.0;
  bool moved = false;
};

/// Looks along each coordinate in turn, `points` to either side of the prior's mean, `reach` of its standard deviations
/// far: the fit of a run that rings has local minima, and a descent finds the nearest one only. A coordinate whose standard
/// deviation is 0 stays.
ScanResult scan_coordinates(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                            const Eigen::VectorXd& prior_mean, const Eigen::VectorXd& prior_std, int points,
                            double reach = 2.5);

/// The same along some coordinates only, closely and not far from `start`.
ScanResult scan_around(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& prior_std, const std::vector<Eigen::Index>& coordinates);

}  // namespace tissue_stiffness
