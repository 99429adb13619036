#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/estimation/patches.hpp"
#include "tissue_stiffness/forward/model.hpp"

namespace tissue_stiffness {

/// Throws InputError, naming `map`, for a model whose modulus cannot be mapped: one that is not linear, or without exactly
/// one constant young_modulus {prior, factor}, or with an estimated poisson_ratio beside it.
void require_map(const Model& model);

/// Tetrahedra of the elasticity whose modulus is mapped.
Patch mapped_tets(const Model& model);

/// The same model with a modulus a patch, K = sum_r E_r K_r: settings and regions of a Model.
struct PatchModel {
  ModelSettings settings;
  std::map<std::string, Region> regions;
  Eigen::Index first = 0;  ///< of the patches' moduli among the free parameters, which they follow each other in
  double common = 0.0;     ///< prior of the one modulus in their place: mean and standard deviation of log E
  double common_std = 0.0;
};

/// `log_modulus`: of each patch, about which its modulus is looked for. Throws as require_map does.
PatchModel with_patches(const Model& model, const std::vector<Patch>& patches, const Eigen::VectorXd& log_modulus);

/// Prior covariance of all free parameters of a patch model: that of its moduli is common_std^2 + smooth_covariance, the
/// body's modulus and how it varies; others keep their own variances.
Eigen::MatrixXd patch_covariance(const PatchModel& patches, const Eigen::VectorXd& prior_std,
                                 const Eigen::MatrixXd& smooth);

}  // namespace tissue_stiffness
