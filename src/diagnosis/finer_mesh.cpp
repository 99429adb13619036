#include "diagnosis/finer_mesh.hpp"

#include <Eigen/Cholesky>
#include <utility>

#include "diagnosis/candidates.hpp"
#include "diagnosis/comparison_numbers.hpp"
#include "estimation/mesh_error.hpp"
#include "fit/coordinate_scan.hpp"
#include "fit/nested_parameters.hpp"
#include "meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostMoves = 8;
constexpr double kStep = 0.01;    // of a prior's standard deviation: width of the differences that tangents are read from
constexpr double kGain = 0.01;    // relative fall of the sum of squares that is worth another move
constexpr double kHarder = 10.0;  // factor of the damping after a step that failed
constexpr double kEasier = 0.3;   // and after another
constexpr double kMostDamping = 1e9;  // of the prior's precision: steps are short enough then

std::shared_ptr<const RecordingFit> on_finer_mesh(const FittedModel& base, const RecordingFit* known) {
  const Model& model = base.recording_fit->model();
  const ModelSettings& settings = model.settings();
  const auto basis = [&](const TetMesh& mesh) {
    BasisOptions options = basis_beside(model.mesh(), mesh);
    options.keep_root = true;
    options.nonlinear = BasisOptions::Nonlinear::left_out;
    options.growths = base.recording_fit->growths();
    return RecordingFit::chosen_at(base.fit, std::move(options));
  };
  if (known != nullptr) return std::make_shared<const RecordingFit>(settings, *known, basis(known->model().mesh()));
  const TetMesh mesh = refined_mesh(model.mesh(), settings.mesh);
  return std::make_shared<const RecordingFit>(settings, mesh, refine_regions(model.body().regions, model.mesh(), mesh),
                                              base.recording_fit->recording(), basis(mesh));
}

// Returns what the base's own mesh predicts at its fit, of what is linear in the model.
Eigen::VectorXd predicted_linearly(const FittedModel& base) {
  const RecordingFit& own = *base.recording_fit;
  if (own.linear()) return base.rows.predicted;
  BasisOptions options = RecordingFit::chosen_at(base.fit);
  options.nonlinear = BasisOptions::Nonlinear::left_out;
  return RecordingFit(own.model().settings(), own, options).predicted(base.fit.w);
}

// Returns the step of Levenberg and Marquardt, in the prior's standard deviations.
Eigen::VectorXd damped_step(const Eigen::MatrixXd& j, const Eigen::VectorXd& error, double damping) {
  Eigen::MatrixXd precision = j.transpose() * j;
  precision.diagonal().array() += damping;
  return precision.ldlt().solve(j.transpose() * error);
}

}  // namespace

// The fit is against the base's own prediction and not against the frames: what is missing would lead it astray. A body
// that rings is soon out of phase with itself at another modulus. So the parameters have to follow, from the best place
// near.
FinerMesh finer_mesh(const FittedModel& base, const RecordingFit* known) {
  FinerMesh out{Eigen::VectorXd::Zero(base.rows.error.size())};
  const Model& model = base.recording_fit->model();
  if (!MeshError::why_not(model).empty()) return out;
  out.recording_fit = on_finer_mesh(base, known);
  const Eigen::VectorXd predicted = predicted_linearly(base);
  const Eigen::VectorXd prior = model.parameters().prior_std();
  const auto change_at = [&](const Eigen::VectorXd& w) {
    return Eigen::VectorXd(base.rows.used.cwiseProduct(out.recording_fit->predicted(w) - predicted));
  };
  const auto cost = [&](const Eigen::VectorXd& w) { return change_at(w).squaredNorm(); };
  Eigen::VectorXd w =
      scan_around(cost, base.fit.w, prior, NestedParameters(*base.recording_fit, *base.recording_fit).tuning()).best;
  out.change = change_at(w);
  double damping = 1.0;
  for (int k = 0; k < kMostMoves; ++k) {
    const Eigen::MatrixXd j = base_tangents(*out.recording_fit, w, kStep * prior, base.rows) * prior.asDiagonal();
    const double before = out.change.squaredNorm();
    Eigen::VectorXd next, change;
    bool lower = false;
    while (!lower && damping < kMostDamping) {
      next = w + prior.cwiseProduct(damped_step(j, -out.change, damping));
      change = change_at(next);
      lower = change.squaredNorm() < before;
      damping *= lower ? kEasier : kHarder;
    }
    if (!lower) break;
    w = next;
    out.change = change;
    if (change.squaredNorm() > (1.0 - kGain) * before) break;
  }
  return out;
}

Eigen::VectorXd mesh_change(const FittedModel& base, const FinerMesh& finer) {
  const bool unknown = finer.recording_fit == nullptr && base.recording_fit->model().settings().mesh.discretisation_error;
  return unknown ? kComparison.unknown_mesh * motion_of(base.rows).cwiseProduct(base.rows.used) : finer.change;
}

}  // namespace tissue_stiffness
