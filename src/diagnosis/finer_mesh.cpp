#include "tissue_stiffness/diagnosis/finer_mesh.hpp"

#include <Eigen/Cholesky>

#include "tissue_stiffness/diagnosis/candidates.hpp"
#include "tissue_stiffness/estimation/coordinate_scan.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostMoves = 8;   // of Gauss and Newton
constexpr double kStep = 0.01;  // of a prior's standard deviation: half of the differences that tangents are read from
constexpr double kGain = 0.01;  // relative fall of the sum of squares that is worth another move

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

// Against the base's own prediction and not against the frames: what is missing would lead this fit astray. A body that
// rings is soon out of phase with itself at another modulus, so the parameters have to follow, from the best place near.
FinerMesh finer_mesh(const Fitted& base, const Study* known) {
  FinerMesh out{Eigen::VectorXd::Zero(base.rows.error.size())};
  const Model& model = base.study->model();
  if (model.nonlinear() || !MeshError::why_not(model).empty()) return out;
  out.study = on_finer_mesh(*base.study, model.settings(), known);
  const Eigen::VectorXd prior = model.prior_std();
  const auto change_at = [&](const Eigen::VectorXd& w) {
    return Eigen::VectorXd(base.rows.used.cwiseProduct(out.study->predicted(w) - base.rows.predicted));
  };
  const auto cost = [&](const Eigen::VectorXd& w) { return change_at(w).squaredNorm(); };
  Eigen::VectorXd w = scan_around(cost, base.fit.w, prior, base.study->tuning_shared_with(*base.study)).best;
  out.change = change_at(w);
  for (int k = 0; k < kMostMoves; ++k) {
    const Eigen::MatrixXd j = base_tangents(*out.study, w, kStep * prior, base.rows) * prior.asDiagonal();
    const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(w.size(), w.size()) + j.transpose() * j;
    const Eigen::VectorXd u = precision.ldlt().solve(j.transpose() * -out.change);
    const Eigen::VectorXd next = w + prior.cwiseProduct(u);
    const Eigen::VectorXd change = change_at(next);
    if (!(change.squaredNorm() < (1.0 - kGain) * out.change.squaredNorm())) break;
    w = next;
    out.change = change;
  }
  return out;
}

}  // namespace tissue_stiffness
