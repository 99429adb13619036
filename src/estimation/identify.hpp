#pragma once

#include <Eigen/Core>
#include <map>
#include <string>

#include "forward/model.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// Below this posterior over prior standard deviation, a parameter counts as determined by the data.
constexpr double learnt = 0.5;

/// Tells what the data determine. A parameter whose posterior is hardly narrower than its prior is `none`. Scales - moduli,
/// densities, added masses, load scales - rescale together without moving anything. When every one of them that acts is
/// unknown, the data give only their ratios. Forces in newton or pascal, or a mass, that are known make the others
/// `absolute`.
std::map<std::string, Identifiability> identify(const Model& model, const Eigen::MatrixXd& covariance);

}  // namespace tissue_stiffness
