#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "estimation/input_study.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/misfit_test.hpp"
#include "forward/model.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

constexpr double kFullSigmas = 1.5;  ///< rms error over noise that passes where the misfit's shape is not tested
/// Of the mean square that the finer mesh changes: what the mesh may leave. At second order this is the whole.
constexpr double kFinerLeaves = 16.0 / 9.0;

/// Returns (C^-1 + P^-1)^-1 of a covariance C that is left open: whatever it is, the prior P still holds.
Eigen::MatrixXd within_prior(const Eigen::MatrixXd& c, const Eigen::VectorXd& prior_std);

/// A filter cannot see errors that agree from frame to frame: those of the mesh, of the inputs, and of the model itself.
/// This class takes them from the last studies, all in the filter's coordinates.
class SystematicError {
 public:
  /// The model has to outlive this.
  explicit SystematicError(const Model& model);

  /// This is the misfit of all frames so far, at a filter's estimate.
  struct FilteredMisfit {
    double scale = 1.0;  ///< its mean square over the noise's
    double rows = 0.0;   ///< of all frames
  };
  /// This is a filter's estimate.
  struct Filtered {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    FilteredMisfit misfit;
  };
  /// This is the estimate to publish.
  struct Corrected {
    Eigen::VectorXd mean;
    Eigen::MatrixXd covariance;
    std::vector<VarianceShares> shares;
  };
  Corrected correct(const Filtered& filtered) const;

  void take_mesh(const MeshError::Answer& answer, double misfit_scale);
  /// `rows` is the number of rows when the study was asked for. set_runs_at() has to follow.
  void take_inputs(InputStudy::Answer answer, double rows);
  /// Sets the runs' parameters, from which the shift to the joint fit of parameters and input errors is counted, and the
  /// scale of the misfit there, of the frames that were studied.
  void set_runs_at(const Eigen::VectorXd& w, double misfit_scale);
  /// Drops the joint fit, which says nothing about the present runs.
  void drop_fit();
  /// Forgets all studies.
  void reset();

  const std::optional<InputStudy::Answer>& inputs() const { return inputs_; }
  bool mesh_known() const { return mesh_left_.has_value(); }
  /// Returns the mean square over the noise's that the mesh may leave.
  double of_mesh() const;
  /// Returns the misfit test of the last study of the inputs, with numerics allowed for.
  const MisfitTest& test() const { return test_; }
  /// Returns whether the estimated errors of the inputs are plausible and leave a misfit that passes. If not, the estimate
  /// is the one under the inputs as they are. Its distance from the joint fit is then part of its discrepancy.
  bool inputs_believed() const;
  /// Returns whether the frames since the last test leave more than noise and mesh, compared with those that were tested.
  /// It is false where no misfit was tested.
  bool misfit_has_risen(const FilteredMisfit& misfit) const;
  /// Returns whether the runs have left the place where the inputs were studied, by more than their standard deviation. A
  /// study says nothing of that deviation where its runs left much more than the present ones: it was asked too early.
  bool left_study(const Filtered& filtered) const;

 private:
  bool misfit_has_fallen(const FilteredMisfit& misfit) const;
  double unexplained(const FilteredMisfit& misfit) const;
  Eigen::VectorXd mesh_shift() const;
  void refresh();

  const Model& model_;
  Eigen::VectorXd mesh_shift_;       ///< estimate less truth because of the mesh; empty: not known yet
  std::optional<double> mesh_left_;  ///< mean square that the mesh leaves
  std::optional<InputStudy::Answer> inputs_;
  Eigen::VectorXd input_shift_;  ///< from the runs' parameters to the joint fit; empty: not known
  Eigen::VectorXd runs_at_;      ///< parameters of the runs
  FilteredMisfit studied_;       ///< of the frames of the last study, at the runs' parameters
  MisfitTest test_;
  /// This is the covariance by its sources, without noise and model, as of the last refresh; it is empty before.
  struct {
    Eigen::MatrixXd mesh, loads, constants, all;
  } parts_;
};

}  // namespace tissue_stiffness
