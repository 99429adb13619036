#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/recording.hpp"
#include "tissue_stiffness/estimation/batch_fit.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"

namespace tissue_stiffness {

/// One model against one recording: free runs and fits. Linear models in their reduced basis, others in full.
class Study {
 public:
  /// Throws as Model does.
  Study(const ModelSettings& settings, const TetMesh& mesh, const Recording& recording, const BasisOptions& basis = {});
  /// With the regions' parts of the mesh as given.
  Study(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions,
        const Recording& recording, const BasisOptions& basis = {});
  Study(const Study&) = delete;
  Study& operator=(const Study&) = delete;

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
  };
  /// The free run at w.
  Rows rows(const Eigen::VectorXd& w) const;
  /// Fits the training frames, or all of them.
  BatchFit fit(const Eigen::VectorXd& start, const Eigen::VectorXd& spread, bool all_frames) const;
  /// Where a coarse look along each coordinate of the prior finds the training frames explained best.
  Eigen::VectorXd scan(const Eigen::VectorXd& start) const;

  /// Index of a free parameter by name; -1 when there is none.
  Eigen::Index index(const std::string& parameter) const;

 private:
  FitProblem problem(const std::vector<Frame>& frames) const;

  const Recording& recording_;
  std::vector<Frame> training_;
  mutable Model model_;
  std::unique_ptr<ForwardModel> forward_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
};

/// Root mean square of the rows' errors over held-out (true) or training frames: in metres, and in sigmas.
double rms_error(const Study::Rows& rows, const Recording& recording, bool held_out);
double rms_sigmas(const Study::Rows& rows, const Recording& recording, bool held_out);
/// Root mean square of the noise that the model file states [m].
double noise_floor(const Study::Rows& rows);

}  // namespace tissue_stiffness
