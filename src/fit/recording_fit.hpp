#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fit/batch_fit.hpp"
#include "fit/corrected_surrogate.hpp"
#include "fit/free_run.hpp"
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

  const Model& model() const { return model_; }
  const Recording& recording() const { return recording_; }

  /// These are all rows of all frames, in sigmas. `used` is 0 where a row says nothing, else the root of its robust weight.
  struct Rows {
    Eigen::VectorXd error;      ///< (measured - predicted) / sigma, times used
    Eigen::VectorXd predicted;  ///< predicted / sigma
    Eigen::VectorXd used;
    Eigen::VectorXd sigma;              ///< [m], or [N] of a force
    Eigen::VectorXi nodes;              ///< nearest mesh node, or kForceRow
    std::vector<Eigen::Index> offsets;  ///< first row of each frame, and the number of rows at the end

    /// Returns the number of rows that say something.
    double count() const { return static_cast<double>((used.array() > 0.0).count()); }
    /// Returns whether a row says something of a length, and not of a force.
    bool tells_length(Eigen::Index row) const { return used[row] > 0.0 && nodes[row] != kForceRow; }
  };
  /// Returns the rows of the free run at w. A nonlinear model takes a quick run, corrected by what quick runs were off at
  /// the last full run. Only fit() and borrow() change which run that is.
  Rows rows(const Eigen::VectorXd& w) const;
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
  Eigen::MatrixXd rows_along(const Eigen::VectorXd& w, const Eigen::MatrixXd& shapes, const Rows& rows) const;
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
  /// Returns the best place of a coarse scan of these coordinates over their whole prior, the others held at `start`.
  Place scan_prior(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& coordinates, double share) const;
  /// Moves coordinates in which the run is linear to where they fit best while the others are held (variable_projection).
  /// It is repeated, because robust weights follow the fit. The result is no worse than `from`, if they are not quite
  /// linear.
  Place project(const Place& from, const std::vector<Eigen::Index>& linear, double share) const;

  /// Returns what is linear in the model, in a reduced basis.
  std::shared_ptr<const ReducedModel> reduced() const;

  /// Returns the index of a free parameter by name; -1 when there is none.
  Eigen::Index index(const std::string& parameter) const;
  /// Returns the indices of the free parameters that `base`, a model with fewer effects, has too.
  std::vector<Eigen::Index> shared_with(const RecordingFit& base) const;
  /// Returns those of them that change how the body answers a load, or when that is seen. What acts on the body is left
  /// out.
  std::vector<Eigen::Index> tuning_shared_with(const RecordingFit& base) const;
  /// Returns those of them along which a fit's start is scanned. A run that rings has other minima where its frequencies
  /// shift. Among the parameters that shift frequencies, only the one whose prior shifts them most is scanned, because the
  /// fit moves the others from there.
  std::vector<Eigen::Index> scanned_shared_with(const RecordingFit& base) const;
  /// Returns those that are not tuning: what acts on the body.
  std::vector<Eigen::Index> acting_shared_with(const RecordingFit& base) const;
  /// Converts `w` of `base` to the coordinates of this model; parameters that `base` lacks stay at their prior.
  Eigen::VectorXd extend(const RecordingFit& base, const Eigen::VectorXd& w) const;
  /// Returns the spread of the sigma points for a first fit from the fit of `base`: narrow in its parameters, wide in the
  /// others.
  Eigen::VectorXd spread_beyond(const RecordingFit& base) const;

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
};

/// A fitted model holds a model, its fit to the training frames, and the free run at that fit.
struct FittedModel {
  std::unique_ptr<RecordingFit> recording_fit;
  BatchFit fit;
  RecordingFit::Rows rows;
};

/// Fits the training frames from `start`, with sigma points `spread` prior standard deviations wide, and runs freely at the
/// fit.
FittedModel fit_recording(std::unique_ptr<RecordingFit> recording_fit, const Eigen::VectorXd& start, double spread);

/// Returns by how much the rows' predictions differ from the first frame's [sigma]; 0 in frames with another number of
/// rows.
Eigen::VectorXd motion_of(const RecordingFit::Rows& rows);

/// Returns the sum of the rows' squared errors beyond the stated noise [sigma^2], or 0.
double structured_squares(const RecordingFit::Rows& rows);

/// Returns the root mean square of the lengths' errors over held-out (true) or training (false) frames [m]; 0 without any.
double rms_error(const RecordingFit::Rows& rows, const Recording& recording, bool held_out);
/// Returns the same over all frames.
double rms_error(const RecordingFit::Rows& rows);
/// Returns the root mean square of the noise that the model file states [m].
double noise_floor(const RecordingFit::Rows& rows);

}  // namespace tissue_stiffness
