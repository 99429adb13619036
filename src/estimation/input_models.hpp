#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "estimation/mesh_error.hpp"
#include "forward/study_model.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {

/// The body of a model with its surface further out. It is run like the body itself, and both share what moves them.
struct OffsetBody {
  double tolerances;  ///< by which its surface lies further out
  Model model;
  std::unique_ptr<ForwardModel> runs;

  /// `tolerance`: 1 sigma [m]. Throws as Model does.
  OffsetBody(const Model& body, double tolerance);
  /// Takes over the loads of the body itself.
  void drive_like(const Model& body);
};

/// These models are run by a study of the inputs, and kept from one study to the next.
struct InputModels {
  Model base;       ///< the estimator's, for its parameters
  Model uncertain;  ///< keeps constants that have a tolerance apart
  std::shared_ptr<ForwardModel> runs;
  std::vector<std::unique_ptr<ObservationOperator>> operators;
  std::vector<UncertainConstant> constants;  ///< those of theta, and at last that of the surface's place
  std::unique_ptr<OffsetBody> offset;        ///< null where the surface's place is exact
  Eigen::MatrixXd rigid;                     ///< translations and rotations of the body, 3n x 6
  bool exhausted = false;                    ///< more vectors do not make the basis of the runs better

  explicit InputModels(const Model& model);
  /// Lets the basis of the runs leave out no more than that of the estimator: what is known of its constants is apart
  /// here, so it takes other vectors.
  void grow_basis(const MeshError::Question& question);
  const ReducedModel& linear_form() const { return linear_form_of(*runs); }
};

}  // namespace tissue_stiffness
