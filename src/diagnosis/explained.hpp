#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "fit/recording_fit.hpp"

namespace tissue_stiffness {

/// A linearisation gives a model's rows about its fit, as far as they are linear in unit normal variables u. Its columns (N
/// x k) [sigma] are those of the free parameters, each times its prior's standard deviation, and of the time steps that a
/// simulated recording is made with.
struct Linearisation {
  Eigen::MatrixXd columns;
  Eigen::Index parameters = 0;           ///< number of these columns, the first ones; the others are numerics
  Eigen::VectorXd prior;                 ///< mean of u, counted from the fit
  std::vector<Eigen::Index> amplitudes;  ///< columns of added effects' amplitudes, whose size is not known beforehand
  double log_root_weights = 0.0;         ///< sum of log sqrt(weight): a row of weight q has the noise's variance over q
};
/// Returns the sum of the logarithms of the roots of the rows' robust weights.
double log_root_weights(const RecordingRows& rows);
/// Linearises a model about its fit. `amplitudes` are given by name.
Linearisation linearise_model(const FittedModel& fitted, const std::vector<std::string>& amplitudes = {});
/// Returns the free parameters with normal priors that a model with fewer effects does not have.
std::vector<std::string> added_amplitudes(const RecordingFit& recording_fit, const RecordingFit& smaller);

/// This is where a model fits whose time steps are fitted, too. The maps are by name, and empty without such a fit.
struct FittedSteps {
  std::map<std::string, double> place;  ///< in the parameters' units
  std::map<std::string, double> moves;  ///< from the fit without them [coordinates w]
  double cost = no_rival;               ///< of the training frames and the prior
};

/// This is what a mesh may err by in a model's rows; see ModelComparison.
struct MeshAllowance {
  Eigen::MatrixXd columns;    ///< D
  Eigen::MatrixXd basis;      ///< B, frame under frame
  Eigen::MatrixXd variances;  ///< L, one column a frame
  Eigen::MatrixXd of_frame;   ///< mean square in one frame: L over the number of frames that count as one
};

/// This is a fitted model as it is compared: its residual and the rows about it.
struct Explained {
  Eigen::VectorXd error;  ///< of each row [sigma]
  Linearisation linearisation;
  FittedSteps steps = {};
  std::shared_ptr<const MeshAllowance> mesh = nullptr;  ///< for the model's test; null: that of the comparison's base
};
/// Says which time steps of a simulated recording are fitted with a linear model: none, those whose tangents matter, or
/// also those that no tangent shows.
enum class FittedNumerics { none, evident, far };
/// Returns the residual to compare. What time steps do to a body that rings for long is not linear in them, so they are
/// fitted with it. `known` is such a fit of a model with fewer effects. Where there is one, this model is fitted with the
/// steps, too, from the best of several starts; a fit whose cost is beyond `rival` may end early.
Explained compared_residual(const FittedModel& fitted, const std::vector<std::string>& amplitudes = {},
                            FittedNumerics numerics = FittedNumerics::evident, const FittedSteps& known = {},
                            double rival = no_rival);

}  // namespace tissue_stiffness
