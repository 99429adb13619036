#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/change.hpp"
#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/estimation/fit_problem.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// The sigma points' free runs over a recording, and the filter that they feed. Frames only add information, until `look`
/// moves the sigma points to where the estimate went and runs the recording again.
class Track {
 public:
  using Operators = std::vector<std::unique_ptr<ObservationOperator>>;
  using Checkpoint = std::function<void()>;  ///< called before every frame of a replay; what it throws ends the look

  Track(const Model& model, const Operators& operators, std::shared_ptr<ForwardModel> forward, AnchoredFilter prior,
        RunStart start);
  /// The same filter, forward model and notes, with runs that have not begun: what a look may move while this one goes on.
  std::unique_ptr<Track> twin() const;

  const AnchoredFilter& filter() const { return filter_; }
  /// Of the parameters: the filter's, and what the reduced basis and a change that began the track leave open.
  Eigen::MatrixXd covariance() const;
  const std::shared_ptr<ForwardModel>& forward() const { return forward_; }
  const RunStart& start() const { return start_; }
  Eigen::VectorXd theta(const Eigen::VectorXd& w) const { return model_.theta(w); }
  /// What the reduced basis leaves out of the surface's motion [m] (basis_error.hpp), as of the last look at it.
  std::optional<double> basis_error() const { return notes_.basis_error; }

  bool begun() const { return ensemble_ != nullptr; }
  /// Lays the sigma points of a track that has not begun around an estimate that other means have found.
  void expect(const Estimate& near);
  void begin();
  void advance(double time) { ensemble_->advance(time); }
  Ensemble::Predicted predict(const Frame& frame) const { return ensemble_->predict(frame); }
  /// Feeds the filter with a frame that was predicted.
  AnchoredFilter::Innovation absorb(const Ensemble::Predicted& predicted);
  /// Advance, predict and absorb.
  AnchoredFilter::Innovation absorb(const Frame& frame);
  /// Weighted sum of the sigma points' displacements, 3n [m].
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const { ensemble_->combine(weights, sum); }

  /// Runs the frames again, under loads that are others now, around the filter coordinates w. Throws NumericalError as runs
  /// do.
  void rerun(const std::vector<Frame>& frames, const Eigen::VectorXd& w);
  /// Whether `look` would do anything after `count` frames.
  bool wants_look(std::size_t count) const;
  /// Moves the sigma points until nothing moves, looks for a better minimum and at the basis, each
  /// when its time has come. True if the runs changed: they are then at the last frame. False, too, when runs on the way
  /// diverge or the checkpoint throws a NumericalError: this track must then not be used.
  bool look(const std::vector<Frame>& frames, const Checkpoint& checkpoint);
  /// A track that goes on from where the parameters changed, where they did: its prior is what the question knew of them
  /// before, with `covariance`, widened by their drift; it is at the last frame. Null where no change is found, and where
  /// runs diverge or the checkpoint throws a NumericalError. `first`: frame that it began with.
  std::unique_ptr<Track> changed(const std::vector<Frame>& frames, const ChangeQuestion& question,
                                 const Checkpoint& checkpoint, std::size_t& first) const;
  /// The same track without its first `first` frames, at the last frame: they are its prior, and its start the motion after
  /// them. Null for a nonlinear model, and when a run diverges or the checkpoint throws a
  /// NumericalError.
  std::unique_ptr<Track> rolled(const std::vector<Frame>& frames, std::size_t first, const Checkpoint& checkpoint) const;
  /// Of a twin whose look changed nothing: not to be repeated.
  void take_notes(const Track& other) { notes_ = other.notes_; }

 private:
  bool look_at(const std::vector<Frame>& frames, const Checkpoint& checkpoint);
  bool bent() const;
  bool stale() const;
  bool settle_is_due(std::size_t count) const;
  bool scan_is_due(std::size_t count) const;
  bool basis_is_due(std::size_t count) const;
  bool settle(const FitProblem& problem);
  void move_anchor(const FitProblem& problem);
  bool scan(const FitProblem& problem);
  bool grow_basis(const FitProblem& problem);
  void replay(const FitProblem& problem, const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread);
  FitProblem problem(const std::vector<Frame>& frames, const Checkpoint& checkpoint) const;

  /// What was looked at when, in frames.
  struct Notes {
    std::size_t settled = 0, scanned = 1, basis = 0;
    std::optional<double> basis_error;  ///< [m]
    bool basis_exhausted = false;       ///< more vectors do not help
    Eigen::VectorXd basis_shift;        ///< what the basis does to the parameters; empty: not known yet
  };

  const Model& model_;
  const Operators& operators_;
  std::shared_ptr<ForwardModel> forward_;
  RunStart start_;
  AnchoredFilter filter_;
  std::unique_ptr<Ensemble> ensemble_;
  Eigen::VectorXd doubt_;  ///< from a change that began it; empty: from rest
  Notes notes_;
};

}  // namespace tissue_stiffness
