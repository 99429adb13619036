#pragma once

#include <Eigen/Core>
#include <memory>

#include "tissue_stiffness/diagnosis/study.hpp"

namespace tissue_stiffness {

/// What a mesh of eight times as many elements with a smooth boundary changes.
struct FinerMesh {
  Eigen::VectorXd change;                        ///< of each row [sigma]; zero where it cannot be found out
  std::shared_ptr<const Study> study = nullptr;  ///< of the model there; null where there is none
};

/// What the base's free run becomes on that mesh, at the parameters there that come closest to it: what they do not take up
/// is the mesh's own error, to within what the next finer mesh would change. It cannot be found out where the model is
/// nonlinear or large, or the model file does not want it. `known`: the mesh of an earlier look, or null.
FinerMesh finer_mesh(const Fitted& base, const Study* known = nullptr);

}  // namespace tissue_stiffness
