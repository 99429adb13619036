#include "estimation/posterior.hpp"

#include <algorithm>
#include <cmath>

#include "filter/interval.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kWidest = 3.0;  // log-normal standard deviation beyond which mean and std say nothing any more

}  // namespace

Estimate summarise_posterior(const std::vector<FreeParameter>& parameters, const Eigen::VectorXd& mean,
                             const Eigen::MatrixXd& covariance) {
  Estimate estimate;
  const auto p = static_cast<Eigen::Index>(parameters.size());
  Eigen::VectorXd scale(p);  // d value / d coordinate
  for (Eigen::Index i = 0; i < p; ++i) {
    const FreeParameter& parameter = parameters[static_cast<std::size_t>(i)];
    const double m = mean[i], s = std::sqrt(std::max(covariance(i, i), 0.0));
    ParameterEstimate out;
    out.name = parameter.name;
    out.unit = parameter.unit;
    const bool positive = parameter.prior.kind == Quantity::Kind::log_normal;
    const Interval interval =
        positive ? log_normal_interval(m, std::pow(std::min(s, kWidest), 2)) : normal_interval(m, s * s);
    out.mean = interval.mean;
    out.std = interval.std;
    out.lower95 = interval.lower95;
    out.upper95 = interval.upper95;
    scale[i] = s > 0.0 ? out.std / s : 1.0;
    estimate.parameters.push_back(out);
  }
  estimate.covariance = scale.asDiagonal() * covariance * scale.asDiagonal();
  return estimate;
}

}  // namespace tissue_stiffness
