#include "diagnosis/finer_mesh.hpp"

#include <Eigen/Cholesky>

#include "diagnosis/candidates.hpp"
#include "estimation/mesh_error.hpp"
#include "fit/coordinate_scan.hpp"
#include "fit/nested_parameters.hpp"
#include "meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostMoves = 8;   // of Gauss-Newton
constexpr double kStep = 0.01;  // of a prior's standard deviation: width of the differences that tangents are read from
constexpr double kGain = 0.01;  // relative fall of the sum of squares that is worth another move

std::shared_ptr<const RecordingFit> on_finer_mesh(const RecordingFit& recording_fit, const ModelSettings& settings,
                                                  const RecordingFit* known) {
  const Model& model = recording_fit.model();
  const auto basis = [&model](const TetMesh& mesh) {
    BasisOptions options = basis_beside(model.mesh(), mesh);
    options.keep_root = true;
    return options;
  };
  if (known != nullptr) return std::make_shared<const RecordingFit>(settings, *known, basis(known->model().mesh()));
  const TetMesh mesh = refined_mesh(model.mesh(), settings.mesh);
  return std::make_shared<const RecordingFit>(settings, mesh, refine_regions(model.body().regions, model.mesh(), mesh),
                                              recording_fit.recording(), basis(mesh));
}

}  // namespace

// The fit is against the base's own prediction and not against the frames: what is missing would lead it astray. A body
// that rings is soon out of phase with itself at another modulus. So the parameters have to follow, from the best place
// near.
FinerMesh finer_mesh(const FittedModel& base, const RecordingFit* known) {
  FinerMesh out{Eigen::VectorXd::Zero(base.rows.error.size())};
  const Model& model = base.recording_fit->model();
  if (model.nonlinear() || !MeshError::why_not(model).empty()) return out;
  out.recording_fit = on_finer_mesh(*base.recording_fit, model.settings(), known);
  const Eigen::VectorXd prior = model.parameters().prior_std();
  const auto change_at = [&](const Eigen::VectorXd& w) {
    return Eigen::VectorXd(base.rows.used.cwiseProduct(out.recording_fit->predicted(w) - base.rows.predicted));
  };
  const auto cost = [&](const Eigen::VectorXd& w) { return change_at(w).squaredNorm(); };
  Eigen::VectorXd w =
      scan_around(cost, base.fit.w, prior, NestedParameters(*base.recording_fit, *base.recording_fit).tuning()).best;
  out.change = change_at(w);
  for (int k = 0; k < kMostMoves; ++k) {
    const Eigen::MatrixXd j = base_tangents(*out.recording_fit, w, kStep * prior, base.rows) * prior.asDiagonal();
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
