#include "tissue_stiffness/diagnosis/study.hpp"

#include <cmath>

#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/coordinate_scan.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kScanPoints = 12;

}  // namespace

std::vector<Frame> Recording::training() const {
  std::vector<Frame> kept;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    if (!held_out(k)) kept.push_back(frames[k]);
  }
  return kept;
}

Study::Study(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording, const BasisOptions& basis)
    : Study(settings, mesh, resolve_regions(settings.regions, mesh), recording, basis) {}

Study::Study(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions,
             const Recording& recording, const BasisOptions& basis)
    : recording_(recording),
      training_(recording.training()),
      model_(settings, mesh, std::move(regions)),
      operators_(make_observation_operators(model_)) {
  model_.set_first_stamp(recording.first_stamp);
  for (const LoadSample& sample : recording.loads) {
    const auto course = model_.courses().find(sample.topic);
    if (course != model_.courses().end()) course->second->add(sample.time, sample.value);
  }
  if (model_.nonlinear()) {
    forward_ = make_forward_model(model_);
  } else {
    forward_ = std::make_unique<ReducedModel>(model_, basis);
  }
  forward_->focus(observed_nodes(operators_, recording.frames));
}

FitProblem Study::problem(const std::vector<Frame>& frames) const {
  return {
      model_, *forward_, operators_, frames, recording_.first_stamp + model_.settings().time.start, recording_.checkpoint};
}

Study::Rows Study::rows(const Eigen::VectorXd& w) const {
  const FitProblem all = problem(recording_.frames);
  Ensemble run(model_, *forward_, operators_);
  run.restart(w, all.start);
  std::vector<Prediction> predictions;
  Rows out;
  out.offsets.push_back(0);
  for (const Frame& frame : recording_.frames) {
    recording_.checkpoint();
    run.advance(frame.time);
    predictions.push_back(run.predict(frame).central);
    out.offsets.push_back(out.offsets.back() + predictions.back().measured.size());
  }
  for (Eigen::VectorXd* v : {&out.error, &out.predicted, &out.used, &out.sigma})
    *v = Eigen::VectorXd::Zero(out.offsets.back());
  out.nodes = Eigen::VectorXi::Zero(out.offsets.back());
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const Prediction& p = predictions[k];
    const Eigen::VectorXd weight = row_weights(p);
    for (Eigen::Index i = 0; i < p.measured.size(); ++i) {
      const Eigen::Index row = out.offsets[k] + i;
      if (!(weight[i] > 0.0) || !std::isfinite(p.sigma[i])) continue;
      out.sigma[row] = p.sigma[i];
      out.nodes[row] = p.nodes[i];
      out.used[row] = std::sqrt(weight[i]);
      out.predicted[row] = p.predicted[i] / p.sigma[i];
      out.error[row] = out.used[row] * (p.measured[i] - p.predicted[i]) / p.sigma[i];
    }
  }
  return out;
}

BatchFit Study::fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, bool all_frames) const {
  return fit_batch(problem(all_frames ? recording_.frames : training_), start, spread);
}

Eigen::VectorXd Study::scan(const Eigen::VectorXd& start) const {
  const FitProblem train = problem(training_);
  return scan_coordinates([&](const Eigen::VectorXd& w) { return free_fit(train, w).cost; }, start, model_.prior_mean(),
                          model_.prior_std(), kScanPoints)
      .best;
}

Eigen::Index Study::index(const std::string& parameter) const {
  const auto& free = model_.free_parameters();
  for (std::size_t i = 0; i < free.size(); ++i) {
    if (free[i].name == parameter) return static_cast<Eigen::Index>(i);
  }
  return -1;
}

namespace {

template <typename Scale>
double root_mean_square(const Study::Rows& rows, const Recording& recording, bool held_out, const Scale& scale) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < recording.frames.size(); ++k) {
    if (recording.held_out(k) != held_out) continue;
    for (Eigen::Index r = rows.offsets[k]; r < rows.offsets[k + 1]; ++r) {
      sum += std::pow(scale(r) * rows.error[r], 2);
      count += rows.used[r] > 0.0 ? 1.0 : 0.0;
    }
  }
  return std::sqrt(sum / count);
}

}  // namespace

double rms_error(const Study::Rows& rows, const Recording& recording, bool held_out) {
  return root_mean_square(rows, recording, held_out, [&](Eigen::Index r) { return rows.sigma[r]; });
}

double rms_sigmas(const Study::Rows& rows, const Recording& recording, bool held_out) {
  return root_mean_square(rows, recording, held_out, [](Eigen::Index) { return 1.0; });
}

double noise_floor(const Study::Rows& rows) {
  return std::sqrt(rows.sigma.squaredNorm() / static_cast<double>((rows.used.array() > 0.0).count()));
}

}  // namespace tissue_stiffness
