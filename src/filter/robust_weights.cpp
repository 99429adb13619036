#include "filter/robust_weights.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <vector>

#include "filter/consistency.hpp"
#include "types/median.hpp"

namespace tissue_stiffness {
namespace {

// Returns the median of the root mean square of `group` standard normal numbers. The value for single rows is stored,
// because every frame needs it.
double normal_median(int group) {
  const auto find = [](int count) { return std::sqrt(chi_squared_quantile(0.5, count) / count); };
  static const double of_one = find(1);
  return group == 1 ? of_one : find(group);
}

}  // namespace

Eigen::VectorXd robust_weights(const Eigen::VectorXd& standardised, int group) {
  if (group < 1 || standardised.size() % group != 0) throw std::invalid_argument("rows do not make whole groups");
  const Eigen::Index groups = standardised.size() / group;
  const Eigen::Map<const Eigen::MatrixXd> rows(standardised.data(), group, groups);
  const Eigen::VectorXd size = rows.colwise().norm().transpose() / std::sqrt(static_cast<double>(group));

  Eigen::VectorXd weights = Eigen::VectorXd::Ones(standardised.size());
  if ((size.array() <= robust_core).all()) return weights;  // whatever the median is
  std::vector<double> finite;
  finite.reserve(static_cast<std::size_t>(groups));
  for (Eigen::Index i = 0; i < groups; ++i) {
    if (std::isfinite(size[i])) finite.push_back(size[i]);
  }
  if (finite.empty()) return weights;
  const double reach = robust_core * std::max(1.0, median_of(std::move(finite)) / normal_median(group));
  for (Eigen::Index i = 0; i < groups; ++i) {
    if (size[i] > reach) weights.segment(i * group, group).setConstant(std::pow(reach / size[i], 2));
  }
  return weights;
}

}  // namespace tissue_stiffness
