#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fit/batch_fit.hpp"
#include "fit/corrected_surrogate.hpp"
#include "fit/free_run.hpp"
#include "fit/recording_rows.hpp"
#include "forward/hyper_basis.hpp"
#include "forward/reduced_model.hpp"
#include "tissue_stiffness/fit/recording.hpp"

namespace tissue_stiffness {

/// A recording fit runs and fits one model against one recording. Linear models run in their reduced basis, others in full.
/// Between two full runs, fits of the others use quick runs: hyper-reduced ones where the model has such a form, else those
/// of what is linear in it.
class RecordingFit {
 public:
  /// Throws as Model does.
  RecordingFit(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
               const BasisOptions& basis = keeping_root());
  /// Takes the regions' parts of the mesh as given.
  RecordingFit(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions,
               const Recording& recording, const BasisOptions& basis = {});
  /// Takes body and recording of `relative` under other effects; what these do not change is reused.
  RecordingFit(const ModelSettings& settings, const RecordingFit& relative, const BasisOptions& basis = keeping_root());
  RecordingFit(const RecordingFit&) = delete;
  RecordingFit& operator=(const RecordingFit&) = delete;

  /// Returns this model with more effects, all absent, at first order about its run in full at w: every free parameter has
  /// its sensitivity (LinearisedModel). Throws InputError where the model has no such form (may_be_linearised).
  std::shared_ptr<const RecordingFit> linearised(const ModelSettings& settings, const Eigen::VectorXd& w) const;
  /// Returns whether it is nonlinear in a way that a study does not run in full, and can be linearised.
  bool may_be_linearised() const;

  /// Returns the basis options of a fit that others will reuse.
  static BasisOptions keeping_root();
  /// Returns `basis` with its vectors chosen at a fit, and within the fit's standard deviations, in place of the prior.
  static BasisOptions chosen_at(const BatchFit& fit, BasisOptions basis = keeping_root());

  /// Returns how often the sizes of the basis have grown, which all that is made from this inherits (BasisOptions).
  int growths() const { return growths_; }
  /// Runs linear() ones in `larger` from now on, which reduced() has grown into by so many growths.
  void take_basis(std::shared_ptr<ReducedModel> larger, int growths);

  const Model& model() const { return model_; }
  const Recording& recording() const { return recording_; }

  /// Returns the rows of the free run at w. A nonlinear model takes a quick run, corrected by what quick runs were off at
  /// the last full run. Only fit() and borrow() change which run that is.
  RecordingRows rows(const Eigen::VectorXd& w) const;
  /// Returns what the free run at w predicts for each row, over sigma; 0 where that is not finite.
  Eigen::VectorXd predicted(const Eigen::VectorXd& w) const;
  /// Shows `visit` each frame of the free run at w, with the displacement of every node. A nonlinear model runs in full.
  /// Returns the misfit of each frame.
  std::vector<Misfit> show(const Eigen::VectorXd& w, const FreeFrameVisitor& visit);
  /// Returns the cost over the training frames at w, sum of squared errors [sigma^2]; a nonlinear model runs in full.
  /// Infinity where the run diverges.
  double cost_in_full(const Eigen::VectorXd& w) const;
  /// Returns the problem that all frames pose, held-out ones too.
  FitProblem whole() const { return problem(*forward_, recording_.frames); }
  /// Takes an estimated error off a measured load, by its topic.
  void correct(const std::string& topic, const LoadErrorBasis& basis, const Eigen::VectorXd& coefficients) {
    model_.loads().courses().at(topic)->correct(basis, coefficients);
  }
  /// Returns d rows / d amplitude of each of `shapes` (3n x count), as a further displacement of the free run at w, N x
  /// count.
  Eigen::MatrixXd rows_along(const Eigen::VectorXd& w, const Eigen::MatrixXd& shapes, const RecordingRows& rows) const;
  /// Fits the training frames. `rival` is explained at fit_batch. A nonlinear model ends where quick runs promise no
  /// better.
  BatchFit fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double rival = no_rival);
  /// Fits the first `share` of the training frames without full runs. `rival` is explained at fit_batch.
  BatchFit quick_fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double share = 1.0,
                     double rival = no_rival) const;
  /// Corrects quick runs by what those of `base`, a fitted model with fewer effects, were off. Where both have a form in
  /// few vectors, quick runs take the base's vectors and points, so what was added must not have a law of its own.
  void borrow(const RecordingFit& base) { borrow(base, model_.parameters().prior_mean(), nullptr, {}); }
  /// The same, for a model that will be at w, with any effects more. It is trained with the base's runs in full, and with
  /// the motion of `seen`, the base at first order, at that one's w. `seen` may be null.
  void borrow(const RecordingFit& base, const Eigen::VectorXd& w, const RecordingFit* seen, const Eigen::VectorXd& seen_w);
  /// Returns where a coarse scan along each coordinate of the prior explains the training frames best.
  Eigen::VectorXd scan(const Eigen::VectorXd& start) const;

  /// Scans some coordinates only, in small steps and not far from `start`, over the first `share` of the training frames.
  /// After another model's fit left them there, a run that rings may need them in another minimum.
  struct Place {
    Eigen::VectorXd w;
    double cost = no_rival;  ///< sum of squared errors over those frames [sigma^2]; infinite where it is not known
  };
  Place scan_near(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& coordinates, double share = 1.0) const;
  /// Returns the best place of a coarse scan of these coordinates over their whole prior, refined between the scan's
  /// points. The others are held at `start`.
  /// Coordinates in which the run is `linear` are solved for at every point, because they decide how well it can fit.
  Place scan_prior(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& coordinates,
                   const std::vector<Eigen::Index>& linear, double share) const;
  /// Moves coordinates in which the run is linear to where they fit best while the others are held (variable_projection).
  /// It is repeated, because robust weights follow the fit. The result is no worse than `from`, if they are not quite
  /// linear.
  Place project(const Place& from, const std::vector<Eigen::Index>& linear, double share) const;

  /// Returns the sum of squared errors over the first `share` of the training frames at each of these places, once
  /// coordinates in which the run is linear have been solved for there.
  std::vector<double> costs(const std::vector<Eigen::VectorXd>& places, const std::vector<Eigen::Index>& linear,
                            double share) const;

  /// Returns what is linear in the model, in a reduced basis.
  std::shared_ptr<const ReducedModel> reduced() const;
  /// Returns whether all runs are those of reduced().
  bool linear() const { return dynamic_cast<const ReducedModel*>(forward_.get()) != nullptr; }

  /// Returns the index of a free parameter by name; -1 when there is none.
  Eigen::Index index(const std::string& parameter) const;

 private:
  RecordingFit(const ModelSettings& settings, const RecordingFit& relative, const BasisOptions* basis);
  void prepare(const BasisOptions* basis, const ForwardModel* relative);
  bool may_be_hyper_reduced() const;
  /// Returns the times of all frames, less the sensors' delay at theta [s].
  std::vector<double> times(const Eigen::VectorXd& theta) const;
  /// `relative`: a model whose vectors and points are taken; null: they are chosen.
  std::shared_ptr<const ForwardModel> make_hyper_reduced(const ForwardModel* relative) const;
  FitProblem problem(const ForwardModel& forward, const std::vector<Frame>& frames) const;
  /// Returns all training frames, or the first of them copied into `room`.
  const std::vector<Frame>& first_of_training(double share, std::vector<Frame>& room) const;
  /// Returns the cost of a free run over the first `share` of the training frames.
  std::function<double(const Eigen::VectorXd&)> cost_of(double share) const;
  /// A full run at one place, and what moves it to other places.
  struct Run {
    std::shared_ptr<const ForwardModel> cheap;
    std::unique_ptr<CorrectedSurrogate> corrected;
  };
  /// Runs in full at w. Quick runs from there are hyper-reduced ones that all runs have trained, to which this one is
  /// added. Without such a form they are those of what is linear in the model.
  Run run_in_full(const Eigen::VectorXd& w);
  BatchFit fit_from_run_to_run(Eigen::VectorXd at, Eigen::VectorXd spread, double rival);
  const ForwardModel& quick() const { return surrogate_ ? *surrogate_ : quick_ ? *quick_ : *forward_; }

  const Recording& recording_;
  std::vector<Frame> training_;
  Model model_;
  std::shared_ptr<ForwardModel> forward_;
  std::shared_ptr<const ForwardModel> quick_;      ///< null: forward_ is quick itself
  FullMotions motions_;                            ///< of all runs in full; of models that have a form in few vectors
  std::unique_ptr<CorrectedSurrogate> surrogate_;  ///< at the last full run; null: none yet
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  int growths_ = 0;  ///< of the basis
};

/// A fitted model holds a model, its fit to the training frames, and the free run at that fit.
struct FittedModel {
  std::unique_ptr<RecordingFit> recording_fit;
  BatchFit fit;
  RecordingRows rows;
};

/// Fits the training frames from `start`, with sigma points `spread` prior standard deviations wide, and runs freely at the
/// fit.
FittedModel fit_recording(std::unique_ptr<RecordingFit> recording_fit, const Eigen::VectorXd& start, double spread);

}  // namespace tissue_stiffness
