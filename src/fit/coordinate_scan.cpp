#include "fit/coordinate_scan.hpp"

#include <utility>

#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kHalvings = 3;
constexpr int kNearPoints = 10;      // on either side of the start
constexpr double kNearReach = 0.45;  // prior standard deviations: steps of 5 % of a modulus known to a factor of 3

}  // namespace

ScanResult scan_coordinates(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                            const Eigen::VectorXd& prior_mean, const Eigen::VectorXd& prior_std, int points, double reach) {
  ScanResult result{start, Eigen::VectorXd::Zero(start.size()), cost(start), false};
  for (Eigen::Index i = 0; i < start.size(); ++i) {
    const double step = reach / points * prior_std[i];
    if (step == 0.0) continue;
    const auto place = [&](int k) {
      Eigen::VectorXd w = result.best;
      w[i] = prior_mean[i] + (k - points) * step;
      return w;
    };
    Eigen::VectorXd costs(2 * points + 1);
    for_each_index(static_cast<std::size_t>(costs.size()), [&](std::size_t i) {
      const int k = static_cast<int>(i);
      costs[k] = cost(place(k));
    });
    Eigen::Index lowest = 0;
    if (!(costs.minCoeff(&lowest) < result.lowest)) continue;
    result.lowest = costs[lowest];
    result.best = place(static_cast<int>(lowest));
    result.step[i] = step;
    result.moved = true;
  }
  return result;
}

ScanResult refine_coordinates(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                              double cost_there, const Eigen::VectorXd& step) {
  ScanResult result{start, step, cost_there, false};
  for (int k = 1; k <= kHalvings; ++k) {
    result.step *= 0.5;
    for (Eigen::Index i = 0; i < start.size(); ++i) {
      if (step[i] == 0.0) continue;
      const Eigen::VectorXd centre = result.best;
      for (const double side : {-1.0, 1.0}) {
        Eigen::VectorXd place = centre;
        place[i] += side * result.step[i];
        const double there = cost(place);
        if (!(there < result.lowest)) continue;
        result.lowest = there;
        result.best = std::move(place);
        result.moved = true;
      }
    }
  }
  return result;
}

ScanResult scan_around(const std::function<double(const Eigen::VectorXd&)>& cost, const Eigen::VectorXd& start,
                       const Eigen::VectorXd& prior_std, const std::vector<Eigen::Index>& coordinates) {
  Eigen::VectorXd scanned = Eigen::VectorXd::Zero(start.size());
  for (const Eigen::Index i : coordinates) scanned[i] = prior_std[i];
  return scan_coordinates(cost, start, start, scanned, kNearPoints, kNearReach);
}

}  // namespace tissue_stiffness
