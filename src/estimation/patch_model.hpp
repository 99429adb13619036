#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "estimation/patches.hpp"
#include "forward/model.hpp"

namespace tissue_stiffness {

/// Throws InputError, naming `map`, for a model whose modulus cannot be mapped. Such a model is not linear, does not have
/// exactly one constant young_modulus {prior, factor}, or has an estimated poisson_ratio as well.
void require_map(const Model& model);

/// Returns the tetrahedra of the elasticity whose modulus is mapped.
Patch mapped_tets(const Model& model);

/// A patch model is a model with one modulus for each patch, K = sum_r E_r K_r: settings and regions of a Model.
struct PatchModel {
  ModelSettings settings;
  std::map<std::string, Region> regions;
  Eigen::Index first = 0;  ///< of the patches' moduli among the free parameters, where they are consecutive
  double common = 0.0;     ///< prior of the one modulus that they replace: mean and standard deviation of log E
  double common_std = 0.0;
};

/// Splits the modulus of `model`. `log_modulus` holds one for each patch, about which its modulus is searched. Throws as
/// require_map does.
PatchModel with_patches(const Model& model, const std::vector<Patch>& patches, const Eigen::VectorXd& log_modulus);

/// Returns the prior covariance of all free parameters of a patch model. Its moduli have common_std^2 + smooth_covariance,
/// the body's modulus and how it varies; other parameters keep their own variances.
Eigen::MatrixXd patch_covariance(const PatchModel& patches, const Eigen::VectorXd& prior_std,
                                 const Eigen::MatrixXd& smooth);

}  // namespace tissue_stiffness
