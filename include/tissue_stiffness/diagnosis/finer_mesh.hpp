#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>

#include "tissue_stiffness/diagnosis/study.hpp"

namespace tissue_stiffness {

/// What a mesh of eight times as many elements with a smooth boundary changes.
struct FinerMesh {
  Eigen::VectorXd change;                        ///< of each row [sigma]; zero where it cannot be found out
  std::shared_ptr<const Study> study = nullptr;  ///< of the model there; null where there is none
};

/// The same model on that mesh and fitted to the same frames: the error that is the mesh's own. It cannot be found out
/// where the model is nonlinear or large, or the model file does not want it. `known`: the mesh of an earlier look, or
/// null.
FinerMesh finer_mesh(const Fitted& base, const Study* known = nullptr);

/// A model on the mesh of `known`, fitted from these parameters.
Fitted fit_on_finer_mesh(const Study& known, const ModelSettings& settings, const std::map<std::string, double>& start);

}  // namespace tissue_stiffness
