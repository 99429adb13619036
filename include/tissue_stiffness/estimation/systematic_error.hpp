#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/input_study.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/estimation/misfit_test.hpp"
#include "tissue_stiffness/forward/model.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

constexpr double kFullSigmas = 1.5;  ///< rms error over noise that passes where the misfit's shape is not tested

/// What a filter cannot see because it agrees from frame to frame: the errors of the mesh, of the inputs, and of the model
/// itself, as the last studies have them. All in the filter's coordinates.
class SystematicError {
 public:
  /// The model has to outlive this.
  explicit SystematicError(const Model& model);

  /// A filter's estimate. misfit_scale: mean square of all frames' misfit there over the noise's.
  struct Filtered {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    double misfit_scale;
  };
  /// The estimate to publish.
  struct Corrected {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    std::vector<VarianceShares> shares;
  };
  Corrected correct(const Filtered& filtered) const;

  void take_mesh(const MeshError::Answer& answer, double misfit_scale);
  /// `misfit_scale`: when the study was asked for. The shift is to be set then.
  void take_inputs(InputStudy::Answer answer, double misfit_scale);
  /// The runs' parameters from which the fit beside the inputs' errors is as far as it is.
  void set_runs_at(const Eigen::VectorXd& w);
  /// The fit beside the inputs' errors says nothing of the present runs.
  void drop_fit();
  /// No study has been made.
  void reset();

  const std::optional<InputStudy::Answer>& inputs() const { return inputs_; }
  bool mesh_known() const { return mesh_left_.has_value(); }
  /// Mean square over the noise's that the mesh may leave.
  double of_mesh() const;
  /// The misfit of the last study of the inputs, numerics allowed for.
  const MisfitTest& test() const { return test_; }
  /// Whether the estimated errors of the inputs are plausible and leave a misfit that passes. If not, the estimate is that
  /// under the inputs as they are, and its distance from the fit beside their errors is part of its doubt.
  bool inputs_believed() const;
  /// Whether the runs have left the place where the inputs were studied.
  bool left_study(const Filtered& filtered) const;

 private:
  double unexplained(double misfit_scale) const;
  Eigen::VectorXd mesh_shift() const;
  Eigen::MatrixXd within_prior(const Eigen::MatrixXd& c) const;
  void refresh();

  const Model& model_;
  Eigen::VectorXd mesh_shift_;       ///< estimate less truth because of the mesh; empty: not known yet
  std::optional<double> mesh_left_;  ///< mean square that the mesh leaves
  std::optional<InputStudy::Answer> inputs_;
  Eigen::VectorXd input_shift_;  ///< from the runs' parameters to the fit beside the inputs' errors; empty: not known
  Eigen::VectorXd runs_at_;      ///< those parameters
  double studied_misfit_scale_ = 1.0;
  MisfitTest test_;
  /// Covariance by where it comes from, beside noise and model, as of the last refresh; empty before.
  struct {
    Eigen::MatrixXd mesh, loads, constants, all;
  } parts_;
};

}  // namespace tissue_stiffness
