#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "estimation/change.hpp"
#include "filter/posterior_linearization_filter.hpp"
#include "fit/ensemble.hpp"
#include "fit/fit_problem.hpp"
#include "forward/full_residual.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// The iterated filter holds the sigma points' free runs over a recording, and the filter that they feed. Frames only add
/// information, until relinearize() moves the sigma points to where the estimate went and runs the recording again.
class IteratedFilter {
 public:
  using Operators = std::vector<std::unique_ptr<ObservationOperator>>;
  using Checkpoint = std::function<void()>;  ///< called before every frame of a replay; what it throws ends it

  IteratedFilter(const Model& model, const Operators& operators, std::shared_ptr<ForwardModel> forward,
                 PosteriorLinearizationFilter prior, RunStart start);
  /// Copies filter, forward model and notes, with runs that have not begun. The copy may be relinearized while this one
  /// goes on.
  std::unique_ptr<IteratedFilter> clone_unstarted() const;

  const PosteriorLinearizationFilter& filter() const { return filter_; }
  /// Returns the parameters: the filter's, less what a hyper-reduced model shifts them by.
  Eigen::VectorXd mean() const;
  /// Returns the parameters' covariance: the filter's, plus what the reduced basis and a change at the start leave open.
  Eigen::MatrixXd covariance() const;
  const std::shared_ptr<ForwardModel>& forward() const { return forward_; }
  const RunStart& start() const { return start_; }
  Eigen::VectorXd theta(const Eigen::VectorXd& w) const { return model_.parameters().theta(w); }
  /// Returns what the reduced basis leaves out of the surface's motion [m] (basis_error.hpp), as of the last check.
  std::optional<double> basis_error() const { return notes_.basis_error; }

  bool begun() const { return ensemble_ != nullptr; }
  /// Places the sigma points of a filter that has not begun around an estimate from elsewhere.
  void expect(const Estimate& near);
  void begin();
  /// Advances the runs. Every few frames a hyper-reduced model's residual in full is compared with that of its last check.
  void advance(double time);
  Ensemble::Predicted predict(const Frame& frame) const { return ensemble_->predict(frame); }
  /// Updates the filter with a frame that was predicted.
  PosteriorLinearizationFilter::Innovation absorb(const Ensemble::Predicted& predicted);
  /// Advances to the frame, predicts it and absorbs it.
  PosteriorLinearizationFilter::Innovation absorb(const Frame& frame);
  /// Writes the weighted sum of the sigma points' displacements, 3n [m].
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const { ensemble_->combine(weights, sum); }

  /// Runs the frames again around the filter coordinates w, after the loads have changed. Throws NumericalError as runs do.
  void rerun(const std::vector<Frame>& frames, const Eigen::VectorXd& w);
  /// Returns whether relinearize() would do anything after `count` frames.
  bool wants_relinearization(std::size_t count) const;
  /// Moves the sigma points until they stay, searches for a better minimum and checks the basis, each when it is due.
  /// Returns true if the runs changed; they are then at the last frame. It also returns false when runs diverge or the
  /// checkpoint throws a NumericalError: this filter must then not be used.
  bool relinearize(const std::vector<Frame>& frames, const Checkpoint& checkpoint);
  /// Returns a filter that goes on from where the parameters changed, at the last frame. Its prior is what the question
  /// knew of them before, with its covariance, widened by their drift. `first` gets the frame that it begins with. Returns
  /// null where no change is found, and where runs diverge or the checkpoint throws a NumericalError.
  std::unique_ptr<IteratedFilter> changed(const std::vector<Frame>& frames, const ChangeQuestion& question,
                                          const Checkpoint& checkpoint, std::size_t& first) const;
  /// Returns this filter without its first `first` frames, at the last frame: they become its prior, and the motion after
  /// them its start. Returns null for a nonlinear model, and when a run diverges or the checkpoint throws a NumericalError.
  std::unique_ptr<IteratedFilter> rolled(const std::vector<Frame>& frames, std::size_t first,
                                         const Checkpoint& checkpoint) const;
  /// Takes the notes of a copy whose relinearization changed nothing, so that it is not repeated.
  void take_notes(const IteratedFilter& other) { notes_ = other.notes_; }

 private:
  bool relinearize_runs(const std::vector<Frame>& frames, const Checkpoint& checkpoint);
  bool bent() const;
  bool stale() const;
  bool settle_is_due(std::size_t count) const;
  bool scan_is_due(std::size_t count) const;
  bool basis_is_due(std::size_t count) const;
  bool settle(const FitProblem& problem);
  void move_anchor(const FitProblem& problem);
  bool scan(const FitProblem& problem);
  bool grow_basis(const FitProblem& problem);
  bool check_hyper_reduction(const FitProblem& problem);
  void watch_residual();
  /// Returns the covariance of what the hyper-reduced model has left out at its last check.
  Eigen::MatrixXd left_by_hyper_reduction() const;
  void replay(const FitProblem& problem, const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread);
  FitProblem problem(const std::vector<Frame>& frames, const Checkpoint& checkpoint) const;

  /// The notes say at how many frames each thing was last done.
  struct Notes {
    std::size_t settled = 0, scanned = 1, basis = 0;
    std::optional<double> basis_error;  ///< [m]
    double residual = 0.0;              ///< largest of a hyper-reduced model at its last check
    double accepted = 0.0;              ///< see ReductionQuestion
    bool surprised = false;             ///< it has become much larger since then
    bool basis_exhausted = false;       ///< more vectors do not help
    Eigen::VectorXd basis_shift;        ///< what the basis does to the parameters, 1 sigma; empty: not known yet
    Eigen::VectorXd correction;         ///< what a hyper-reduced model shifts them by; empty: nothing
  };

  const Model& model_;
  const Operators& operators_;
  std::shared_ptr<ForwardModel> forward_;
  RunStart start_;
  PosteriorLinearizationFilter filter_;
  std::unique_ptr<Ensemble> ensemble_;
  Eigen::VectorXd discrepancy_;  ///< from a change at the start; empty: from rest
  Notes notes_;
  std::unique_ptr<FullResidual> residual_;  ///< of the central run; null: not needed yet
  int unwatched_ = 0;                       ///< frames since it was last computed
};

}  // namespace tissue_stiffness
