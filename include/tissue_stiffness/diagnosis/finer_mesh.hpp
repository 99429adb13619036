#pragma once

#include <Eigen/Core>
#include <memory>

#include "tissue_stiffness/diagnosis/ranking.hpp"
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

/// Sum of squared errors over sigma of the refit's model on that mesh, fitted again.
double cost_on_finer_mesh(const Fitted& base, const Refit& refit, const Study* known);

}  // namespace tissue_stiffness
