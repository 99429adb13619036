#include "tissue_stiffness/diagnosis/finer_mesh.hpp"

#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/meshing/refine.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpread = 0.02;  // prior standard deviations: the finer mesh's fit is close

std::shared_ptr<const Study> on_finer_mesh(const Study& study, const ModelSettings& settings, const Study* known) {
  const Model& model = study.model();
  const auto basis = [&model](const TetMesh& mesh) {
    BasisOptions options = basis_beside(model.mesh(), mesh);
    options.keep_root = true;
    return options;
  };
  if (known != nullptr) return std::make_shared<const Study>(settings, *known, basis(known->model().mesh()));
  const TetMesh mesh = finer(model.mesh(), settings.mesh);
  return std::make_shared<const Study>(settings, mesh, refine(model.regions(), model.mesh(), mesh), study.recording(),
                                       basis(mesh));
}

}  // namespace

// Fitted anew, because a body that rings is soon out of phase with itself at another modulus: at the base's modulus the
// finer mesh would differ by far more than by what it explains.
FinerMesh finer_mesh(const Fitted& base, const Study* known) {
  FinerMesh out{Eigen::VectorXd::Zero(base.rows.error.size())};
  const Model& model = base.study->model();
  if (model.nonlinear() || !MeshError::why_not(model).empty()) return out;
  out.study = on_finer_mesh(*base.study, model.settings(), known);
  const BatchFit fit = out.study->fit(base.fit.w, kSpread * model.prior_std());
  const Study::Rows rows = out.study->rows(fit.w);
  if (rows.predicted.size() != base.rows.predicted.size()) return out;
  out.change = base.rows.used.cwiseProduct(rows.predicted - base.rows.predicted);
  return out;
}

Fitted fit_on_finer_mesh(const Study& known, const ModelSettings& settings, const std::map<std::string, double>& start) {
  auto study = std::make_unique<Study>(settings, known);
  const Model& model = study->model();
  return fit_study(std::move(study), model.coordinates(start, model.prior_mean()), kSpread);
}

}  // namespace tissue_stiffness
