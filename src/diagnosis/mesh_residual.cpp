#include "tissue_stiffness/diagnosis/finding.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/meshing/refine.hpp"

namespace tissue_stiffness {

Eigen::VectorXd mesh_residual(const Study& base, const Eigen::VectorXd& w, const Study::Rows& rows) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(rows.error.size());
  const ModelSettings& settings = base.model().settings();
  const TetMesh& mesh = base.model().mesh();
  if (!settings.mesh.discretisation_error || base.model().nonlinear() || !MeshError::why_not(mesh).empty()) {
    return none;
  }
  const TetMesh fine_mesh = finer(mesh);
  const Study fine(settings, fine_mesh, refine(base.model().regions(), mesh, fine_mesh), base.recording());
  const Study::Rows finer_rows = fine.rows(w);
  if (finer_rows.predicted.size() != rows.predicted.size()) return none;
  return rows.used.cwiseProduct(finer_rows.predicted - rows.predicted);
}

}  // namespace tissue_stiffness
