#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// Posterior over prior standard deviation below which the data have spoken.
constexpr double learnt = 0.5;

/// What the data determine. A parameter whose posterior is hardly narrower than its prior is `none`. Scales - moduli,
/// densities, added masses, load scales - rescale together without moving anything: when every one of them that acts is
/// unknown, the data give only their ratios. Forces in newton or pascal, or a mass, that are known make the others
/// `absolute`.
std::map<std::string, Identifiability> identify(const Model& model, const Eigen::MatrixXd& covariance);

}  // namespace tissue_stiffness
