#include "estimation/hyper_reduction.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "estimation/basis_error.hpp"
#include "forward/full_residual.hpp"
#include "forward/hyper_reduced_model.hpp"
#include "meshing/surface.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kSnapshots = 64;  // of one training, about
constexpr int kMostTrainings = 2;        // with more vectors and points each time
constexpr double kLeastGain = 0.7;       // of the error: a training that leaves more is the last
constexpr double kAgain = 1.5;           // times the error that no training made smaller: it is tried again
constexpr double kMostLeft = 1.0;        // of the noise: beyond it runs stay in full

FullModel::Options full_options(const ForwardModel& forward) {
  if (const auto* reduced = dynamic_cast<const HyperReducedModel*>(&forward)) return reduced->options().full;
  return dynamic_cast<const FullModel&>(forward).options();
}

// A run in full that was recorded at some frames.
class RecordedRun : public Trajectory {
 public:
  void record(double time, Eigen::VectorXd displacement) {
    times_.push_back(time);
    displacements_.push_back(std::move(displacement));
  }
  // Goes to the last instant recorded not after `time`.
  void advance(double time) override {
    while (at_ + 1 < times_.size() && times_[at_ + 1] <= time) ++at_;
  }
  double time() const override { return times_[at_]; }
  Eigen::VectorXd displacement() const override { return displacements_[at_]; }
  Eigen::VectorXd velocity() const override { return Eigen::VectorXd::Zero(displacements_[at_].size()); }
  void rewind() { at_ = 0; }
  std::size_t size() const { return times_.size(); }
  double time_of(std::size_t k) const { return times_[k]; }
  const Eigen::VectorXd& displacement_of(std::size_t k) const { return displacements_[k]; }

 private:
  std::vector<double> times_;
  std::vector<Eigen::VectorXd> displacements_;
  std::size_t at_ = 0;
};

class Reducer {
 public:
  Reducer(const FitProblem& problem, const std::shared_ptr<ForwardModel>& forward, const ReductionQuestion& question)
      : problem_(problem),
        question_(question),
        options_(full_options(*forward)),
        reduced_(std::dynamic_pointer_cast<HyperReducedModel>(forward)),
        forward_(forward),
        surface_(surface_nodes(problem.model.mesh())) {}

  HyperReduction reduce() {
    run_in_full();
    if (leaps_) return {in_full(forward_), std::nullopt, {}, 0.0, 0.0};
    double error = reduced_ ? compare(*reduced_) : std::numeric_limits<double>::infinity();
    double accepted = question_.accepted;
    HyperOptions finer;
    finer.full = options_;
    if (reduced_) finer = reduced_->options();
    for (int k = 0; k < kMostTrainings && error > std::max(kHyperShare, question_.accepted); ++k) {
      if (k > 0 || reduced_) finer = k == 0 ? reduced_->options() : finer.finer();
      auto next = std::make_shared<HyperReducedModel>(problem_.model, motions_, finer);
      const double now = compare(*next);
      const bool helps = !std::isfinite(now) || now < kLeastGain * error;
      if (now < error) {
        error = now;
        reduced_ = std::move(next);
      }
      if (helps) continue;
      accepted = std::min(kAgain * error, kMostLeft);  // before it is given up, it is trained again
      break;
    }
    if (!(error < kMostLeft)) return {in_full(forward_), std::nullopt, {}, 0.0, 0.0};
    reduced_->restrict_output_to(observed_nodes(problem_.operators, problem_.frames));
    return {reduced_, error * least_noise(problem_.model), shift(), residual(), accepted};
  }

 private:
  std::vector<Eigen::VectorXd> thetas() const {
    std::vector<Eigen::VectorXd> out{problem_.model.parameters().theta(question_.w)};
    for (Eigen::Index i = 0; !reduced_ && i < question_.sigma_points.cols(); ++i) {
      out.push_back(problem_.model.parameters().theta(question_.sigma_points.col(i)));
    }
    return out;
  }

  // Records the motion of the first run at checked frames, and snapshots of all runs.
  void run_in_full() {
    const std::vector<Eigen::VectorXd> all = thetas();
    const std::size_t steps = problem_.frames.size() * static_cast<std::size_t>(options_.steps_per_frame);
    const std::size_t stride = (steps * all.size() + kSnapshots - 1) / static_cast<std::size_t>(kSnapshots);
    std::vector<Eigen::VectorXd> snapshots;
    std::vector<Eigen::VectorXd> at;
    std::size_t step = 0, moved = 0;
    FullModel::Options watched = options_;
    watched.after_step = [&](const std::vector<DynamicState>& states) {
      if (step++ % stride != 0) return;
      for (std::size_t i = 0; i < states.size(); ++i) {
        snapshots.push_back(states[i].displacement);
        at.push_back(all[i]);
      }
    };
    const FullModel full(problem_.model, watched);
    const auto runs = full.start_all(all, problem_.start.time);
    std::vector<double> times(all.size());
    Eigen::VectorXd u(problem_.model.fem().dof_count());
    const Eigen::VectorXd first = Eigen::VectorXd::Unit(static_cast<Eigen::Index>(all.size()), 0);
    for (std::size_t k = 0; k < problem_.frames.size(); ++k) {
      problem_.checkpoint();
      for (std::size_t i = 0; i < all.size(); ++i) {
        times[i] = problem_.frames[k].time - problem_.model.sensors().delay(all[i]);
      }
      if (*std::min_element(times.begin(), times.end()) > problem_.start.time) ++moved;
      runs->advance(times);
      if (!is_checked(k, problem_)) continue;
      runs->combine(first, u);
      truth_.record(times.front(), u);
    }
    leaps_ = step < moved * static_cast<std::size_t>(options_.steps_per_frame) && options_.step <= 0.0;
    motions_ = {Eigen::MatrixXd(u.size(), static_cast<Eigen::Index>(snapshots.size())), std::move(at)};
    for (std::size_t k = 0; k < snapshots.size(); ++k)
      motions_.displacements.col(static_cast<Eigen::Index>(k)) = snapshots[k];
    if (reduced_) motions_.add(reduced_->motions().thinned(kSnapshots));
  }

  // Returns the error in standard deviations of the noise; infinity where the reduced run diverges.
  double compare(const HyperReducedModel& reduced) const {
    const Eigen::VectorXd theta = problem_.model.parameters().theta(question_.w);
    const auto run = reduced.start(theta, problem_.start.time);
    double square = 0.0;
    try {
      for (std::size_t k = 0, checked = 0; k < problem_.frames.size(); ++k) {
        problem_.checkpoint();
        run->advance(problem_.frames[k].time - problem_.model.sensors().delay(theta));
        if (!is_checked(k, problem_)) continue;
        const Eigen::VectorXd off = run->displacement() - truth_.displacement_of(checked++);
        double sum = 0.0;
        for (const int node : surface_) sum += off.segment<3>(3 * node).squaredNorm();
        square = std::max(square, sum);
      }
    } catch (const NumericalError&) {
      return std::numeric_limits<double>::infinity();
    }
    const double rms = kBasisSafety * std::sqrt(square / (3.0 * static_cast<double>(surface_.size())));
    return rms / least_noise(problem_.model);
  }

  double residual() const {
    const Eigen::VectorXd theta = problem_.model.parameters().theta(question_.w);
    const FullResidual residual(problem_.model, theta);
    HyperReducedTrajectory run(*reduced_, theta, problem_.start.time);
    double most = 0.0;
    for (std::size_t k = 0; k < problem_.frames.size(); ++k) {
      run.advance(problem_.frames[k].time - problem_.model.sensors().delay(theta));
      if (is_checked(k, problem_) && run.time() > problem_.start.time) most = std::max(most, residual.of(run));
    }
    return most;
  }

  Eigen::VectorXd shift() {
    truth_.rewind();
    const auto start = [this](const Eigen::VectorXd& theta) { return reduced_->start(theta, problem_.start.time); };
    return fitted_shift(problem_, truth_, start, question_.w, question_.spread, question_.prior_std);
  }

  const FitProblem& problem_;
  const ReductionQuestion& question_;
  FullModel::Options options_;
  std::shared_ptr<HyperReducedModel> reduced_;
  std::shared_ptr<ForwardModel> forward_;
  std::vector<int> surface_;
  FullMotions motions_;
  bool leaps_ = false;  ///< runs in full take explicit steps
  RecordedRun truth_;
};

}  // namespace

bool may_be_hyper_reduced(const Model& model) {
  return model.nonlinear() && why_not_hyper_reduced(model).empty();
}

std::shared_ptr<ForwardModel> in_full(const std::shared_ptr<ForwardModel>& forward) {
  const auto reduced = std::dynamic_pointer_cast<HyperReducedModel>(forward);
  return reduced ? std::make_shared<FullModel>(reduced->model(), reduced->options().full) : forward;
}

HyperReduction hyper_reduce(const FitProblem& problem, const std::shared_ptr<ForwardModel>& forward,
                            const ReductionQuestion& question) {
  return Reducer(problem, forward, question).reduce();
}

}  // namespace tissue_stiffness
