#include "tissue_stiffness/diagnosis/finding.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/meshing/refine.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpread = 0.02;  // prior standard deviations: the finer mesh's fit is close

Study on_finer_mesh(const Study& study, const ModelSettings& settings) {
  const Model& model = study.model();
  const TetMesh mesh = finer(model.mesh(), settings.mesh);
  return {settings, mesh, refine(model.regions(), model.mesh(), mesh), study.recording(), basis_beside(model.mesh(), mesh)};
}

}  // namespace

// Fitted anew, because a body that rings is soon out of phase with itself at another modulus: at the base's modulus the
// finer mesh would differ by far more than by what it explains.
Eigen::VectorXd finer_mesh(const Fitted& base) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(base.rows.error.size());
  const Model& model = base.study->model();
  if (model.nonlinear() || !MeshError::why_not(model).empty()) return out;
  const Study fine = on_finer_mesh(*base.study, model.settings());
  const BatchFit fit = fine.fit(base.fit.w, kSpread * model.prior_std());
  const Study::Rows rows = fine.rows(fit.w);
  if (rows.predicted.size() != base.rows.predicted.size()) return out;
  return base.rows.used.cwiseProduct(rows.predicted - base.rows.predicted);
}

double cost_on_finer_mesh(const Fitted& base, const Refit& refit) {
  const Study fine = on_finer_mesh(*base.study, extend_model(base.study->model().settings(), refit.entries));
  const Eigen::VectorXd start = fine.model().coordinates(refit.parameters, fine.model().prior_mean());
  const BatchFit fit =
      fine.fit(fine.scan_near(start, fine.tuning_shared_with(*base.study)).w, fine.spread_beyond(*base.study));
  return fine.rows(fit.w).error.squaredNorm();
}

}  // namespace tissue_stiffness
