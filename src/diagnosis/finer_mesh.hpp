#pragma once

#include <Eigen/Core>
#include <memory>

#include "fit/recording_fit.hpp"

namespace tissue_stiffness {

/// It tells what a mesh of eight times as many elements with a smooth boundary changes.
struct FinerMesh {
  Eigen::VectorXd change;                                       ///< of each row [sigma]; zero where it cannot be computed
  std::shared_ptr<const RecordingFit> recording_fit = nullptr;  ///< of the model on that mesh; null where there is none
};

/// Computes by how much the base's free run changes on that mesh, at the parameters there that come closest to it. What
/// these parameters do not take up is the mesh's own error, to within what the next finer mesh would change. A nonlinear
/// model runs only what is linear in it on both meshes: its strain differs, but not the shapes that the elements lack. This
/// is not done for a contact or a large model, or where the model file forbids it. `known` is the fit on that mesh from an
/// earlier round, or null.
FinerMesh finer_mesh(const FittedModel& base, const RecordingFit* known = nullptr);

/// Returns the change of each row [sigma]. It is `unknown_mesh` of the motion for a mesh that cannot be refined.
Eigen::VectorXd mesh_change(const FittedModel& base, const FinerMesh& finer);

}  // namespace tissue_stiffness
