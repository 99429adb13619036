#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "forward/forward_model.hpp"
#include "forward/hyper_basis.hpp"
#include "forward/output_rows.hpp"
#include "forward/quadratic_force.hpp"

namespace tissue_stiffness {

/// A model under finite strain in few vectors, u = V q, whose elastic forces are summed over few quadrature points:
///   V^T M V q'' + V^T C V q' + sum over points of w_p G_p^T P(I + G_p q) = V^T (gravity + loads).
/// Vectors and points are chosen for the motions of runs in full (see choose_hyper_basis). Steps are those of FullModel
/// (generalised-alpha), solved by Newton's method. Thread safe.
class HyperReducedModel : public ForwardModel {
 public:
  /// Throws InputError for a model that has no such form (why_not_hyper_reduced).
  HyperReducedModel(const Model& model, FullMotions motions, const HyperOptions& options);
  /// Takes vectors and points of a relative, whose mesh and laws are the same.
  HyperReducedModel(const Model& model, const HyperReducedModel& relative);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  std::unique_ptr<Trajectories> start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const override;
  std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const override;
  std::unique_ptr<Trajectories> resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                           const Trajectory& from) const override;
  void restrict_output_to(const OutputNodes& nodes) override { output_.restrict_to(basis_.vectors, nodes); }
  const OutputNodes& output_nodes() const { return output_.nodes(); }
  std::string description() const override;

  const Model& model() const { return model_; }
  const HyperBasis& basis() const { return basis_; }
  const HyperOptions& options() const { return options_; }
  /// Returns what it was trained with.
  const FullMotions& motions() const { return motions_; }
  /// Returns the displacement of every node, 3n, and those of the output (see OutputRows).
  void recover(const Eigen::VectorXd& coordinates, Eigen::Ref<Eigen::VectorXd> displacement) const;
  void displacements(const Eigen::MatrixXd& coordinates, Eigen::MatrixXd& out) const {
    output_.displacements(basis_.vectors, coordinates, out);
  }

  /// One part's linear terms in the basis, and its load that follows the surface.
  struct Projected {
    std::vector<Eigen::MatrixXd> mass, stiffness;
    std::vector<Eigen::VectorXd> loads;
    std::vector<Eigen::MatrixX3d> weight;  ///< each mass term times a unit acceleration along each axis
    std::optional<QuadraticForce> follower;
  };
  const std::vector<Projected>& projected() const { return projected_; }
  /// Returns the coordinates of a unit velocity along each axis of all nodes that are not held, m x 3.
  const Eigen::MatrixX3d& unit_velocity() const { return unit_velocity_; }
  /// Returns the number of steps over a span between frames [s].
  int steps(double span) const;
  /// Returns the least correction of coordinates that a step takes.
  double tolerance() const;

 private:
  void require_form() const;
  void project_motion();
  void project_parts();
  QuadraticForce project(const FollowerLoad& load) const;

  const Model& model_;
  HyperOptions options_;
  FullMotions motions_;
  HyperBasis basis_;
  std::vector<Projected> projected_;
  Eigen::MatrixX3d unit_velocity_;
  double size_ = 0.0;  ///< coordinates of a motion by the body's size, root mean square
  OutputRows output_;
};

}  // namespace tissue_stiffness
