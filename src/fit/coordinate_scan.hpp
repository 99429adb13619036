#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace tissue_stiffness {

/// A scan result tells where a cost was found lowest.
struct ScanResult {
  Eigen::VectorXd best;
  Eigen::VectorXd step;  ///< between the evaluated points, along each coordinate; 0 where none was better
  double lowest = 0.0;
  bool moved = false;
};

/// Evaluates the cost along each coordinate in turn, at `points` places to either side of the prior's mean, up to `reach`
/// of its standard deviations away. The fit of a run that rings has local minima, and a descent finds only the nearest one.
/// A coordinate whose standard deviation is 0 stays.
ScanResult scan_coordinates(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                            const Eigen::VectorXd& prior_mean, const Eigen::VectorXd& prior_std, int points,
                            double reach = 2.5);

/// Moves each coordinate of a place by 1/2, 1/4 and 1/8 of its `step` to the side where the cost is lower, because a
/// minimum lies between the points of a scan. `cost_there` is the cost at `start`.
ScanResult refine_coordinates(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                              double cost_there, const Eigen::VectorXd& step);

/// Scans like scan_coordinates, but along some coordinates only, in small steps and not far from `start`.
ScanResult scan_around(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& prior_std, const std::vector<Eigen::Index>& coordinates);

}  // namespace tissue_stiffness
