#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "observation/observation_operator.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/prediction.hpp"

namespace tissue_stiffness {

/// Predicts the rows of a frame's observations from a run's output (see Model::output_size). The sensors' effects act on
/// its displacement with the parameters theta.
Prediction predict_frame(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                         const Frame& frame, const Eigen::VectorXd& theta, const Eigen::Ref<const Eigen::VectorXd>& output);

/// Returns true if the frame holds only forces and positions of named nodes or markers, which are linear in the
/// displacement, and no parameter of a sensor changes them.
bool sees_named_nodes(const Model& model, const Frame& frame);

/// Returns d predicted rows / d amplitude of each of `shapes` (3n x count) about a run's output, as rows x count. Rows
/// without a counterpart are 0 or NaN. Rows of a force do not depend on displacements alone, so theirs are 0.
Eigen::MatrixXd predict_along(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                              const Frame& frame, const Eigen::VectorXd& theta,
                              const Eigen::Ref<const Eigen::VectorXd>& output, const Eigen::MatrixXd& shapes);

/// Returns the frame's prediction for a body that has not moved.
Prediction predict_at_rest(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                           const Frame& frame);

}  // namespace tissue_stiffness
