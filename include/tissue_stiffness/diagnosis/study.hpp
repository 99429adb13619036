#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/recording.hpp"
#include "tissue_stiffness/estimation/batch_fit.hpp"
#include "tissue_stiffness/estimation/free_run.hpp"
#include "tissue_stiffness/forward/anchored_model.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"

namespace tissue_stiffness {

/// One model against one recording: free runs and fits. Linear models in their reduced basis, others in full; fits of those
/// find the way from one full run to the next by quick runs of what is linear in them.
class Study {
 public:
  /// Throws as Model does.
  Study(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording,
        const BasisOptions& basis = keeping_root());
  /// With the regions' parts of the mesh as given.
  Study(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions,
        const Recording& recording, const BasisOptions& basis = {});
  /// The same body and recording under other effects: what they do not change is not found out anew.
  Study(const ModelSettings& settings, const Study& relative, const BasisOptions& basis = keeping_root());
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

  /// For a study that has relatives to come.
  static BasisOptions keeping_root();

  const Model& model() const { return model_; }
  const Recording& recording() const { return recording_; }

  /// All rows of all frames, in sigmas. `used` is 0 where a row says nothing, else the root of its robust weight.
  struct Rows {
    Eigen::VectorXd error;      ///< (measured - predicted) / sigma, times used
    Eigen::VectorXd predicted;  ///< predicted / sigma
    Eigen::VectorXd used;
    Eigen::VectorXd sigma;              ///< [m]
    Eigen::VectorXi nodes;              ///< nearest mesh node
    std::vector<Eigen::Index> offsets;  ///< first row of each frame, and the number of rows at the end

    /// Of the rows that say something.
    double count() const { return static_cast<double>((used.array() > 0.0).count()); }
  };
  /// The free run at w. Of a nonlinear model it is off by as much as quick runs were at the last full run of a fit, here or
  /// in the study that was borrowed from.
  Rows rows(const Eigen::VectorXd& w) const;
  /// What it predicts of each row, over sigma; 0 where that is not finite.
  Eigen::VectorXd predicted(const Eigen::VectorXd& w) const;
  /// The free run at w, full of a nonlinear model, and where every node is: `visit` sees each frame.
  void show(const Eigen::VectorXd& w, const FreeFrameVisitor& visit);
  /// d rows / d amplitude of each of `shapes` (3n x count) as a further displacement of the free run at w, N x count.
  Eigen::MatrixXd rows_along(const Eigen::VectorXd& w, const Eigen::MatrixXd& shapes, const Rows& rows) const;
  /// Fits the training frames.
  BatchFit fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread) const;
  /// The same without full runs, of the first `share` of them. `rival`: see fit_batch.
  BatchFit quick_fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, double share = 1.0,
                     double rival = no_rival) const;
  /// Lets quick runs be off by as much as those of a fitted model with fewer effects.
  void borrow(const Study& base);
  /// Where a coarse look along each coordinate of the prior finds the training frames explained best.
  Eigen::VectorXd scan(const Eigen::VectorXd& start) const;

  /// The same along some coordinates only, closely and not far from `start`: where a fit of something else left them, a run
  /// that rings may need them in another minimum. Over the first `share` of the training frames; `cost`: there.
  struct Place {
    Eigen::VectorXd w;
    double cost = 0.0;  ///< sum of squared errors [sigma^2]
  };
  Place scan_near(const Eigen::VectorXd& start, const std::vector<Eigen::Index>& coordinates, double share = 1.0) const;

  /// What is linear in the model, in a reduced basis.
  std::shared_ptr<const ReducedModel> reduced() const;

  /// Index of a free parameter by name; -1 when there is none.
  Eigen::Index index(const std::string& parameter) const;
  /// Indices of the free parameters that a model with fewer effects has, too.
  std::vector<Eigen::Index> shared_with(const Study& base) const;
  /// Those of them that change how the body answers a load, or when that is seen: not what acts on it.
  std::vector<Eigen::Index> tuning_shared_with(const Study& base) const;
  /// `w` of that model in the coordinates of this one; what is more stays at its prior.
  Eigen::VectorXd extend(const Study& base, const Eigen::VectorXd& w) const;
  /// Of the sigma points of a first fit from there: close around what that model has found, wide along what is more.
  Eigen::VectorXd spread_beyond(const Study& base) const;

 private:
  void prepare(const BasisOptions& basis, const ForwardModel* relative);
  FitProblem problem(const ForwardModel& forward, const std::vector<Frame>& frames) const;
  /// All of them, or copies in `room`.
  const std::vector<Frame>& first_of_training(double share, std::vector<Frame>& room) const;
  BatchFit fit_from_run_to_run(Eigen::VectorXd at, Eigen::VectorXd spread) const;
  const ForwardModel& quick() const { return anchored_ ? *anchored_ : quick_ ? *quick_ : *forward_; }

  const Recording& recording_;
  std::vector<Frame> training_;
  mutable Model model_;
  std::shared_ptr<ForwardModel> forward_;
  std::unique_ptr<ForwardModel> quick_;              ///< null: forward_ is quick
  mutable std::unique_ptr<AnchoredModel> anchored_;  ///< to the last full run; null: none yet
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
};

/// A model, its fit to the training frames, and the free run there.
struct Fitted {
  std::unique_ptr<Study> study;
  BatchFit fit;
  Study::Rows rows;
};

/// Fits the training frames from `start`, sigma points `spread` prior standard deviations wide, and runs freely there.
Fitted fit_study(std::unique_ptr<Study> study, const Eigen::VectorXd& start, double spread);

/// What the rows' predictions go beyond the first frame's [sigma]; 0 in frames that see something else.
Eigen::VectorXd motion_of(const Study::Rows& rows);

/// Sum of the rows' squared errors beyond the noise that is stated [sigma^2], or 0.
double structured_squares(const Study::Rows& rows);

/// Root mean square of the rows' errors over held-out (true) or training frames [m].
double rms_error(const Study::Rows& rows, const Recording& recording, bool held_out);
/// Root mean square of the noise that the model file states [m].
double noise_floor(const Study::Rows& rows);

}  // namespace tissue_stiffness
