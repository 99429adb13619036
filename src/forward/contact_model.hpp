#pragma once

#include <Eigen/Core>
#include <memory>
#include <mutex>
#include <vector>

#include "forward/forward_model.hpp"
#include "forward/nodal_flexibility.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// A held body that is linear but for its contacts. The modes of a reduced basis carry its inertia. What they lack of the
/// static response to forces at single nodes is added (residual flexibility; MacNeal 1971, Rubin 1975):
///   u = Phi q + (K^-1 - Phi Omega^-2 Phi^T) s,    s + beta s' + sum gamma (s - z) = f,    tau z' = s - z,
/// where f are the nodal forces of the contacts, and q follows them as it follows other loads. So a step solves for the
/// forces at the nodes that touch (Newton), and not for the motion of the whole body.
class ContactModel : public ForwardModel {
 public:
  /// Returns whether the model is such a body.
  static bool suits(const Model& model);

  /// Throws as ReducedModel does.
  ContactModel(const Model& model, const BasisOptions& options, const ReducedModel* relative = nullptr);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const override;
  void restrict_output_to(const OutputNodes& nodes) override;
  std::string description() const override;

  /// Whether the output is restricted to the contacts' reactions, for which no body's motion is solved.
  bool gives_forces_alone() const { return reduced_.output_nodes() && reduced_.output_nodes()->empty(); }

  const Model& model() const { return reduced_.model(); }
  const ReducedModel& reduced() const { return reduced_; }
  /// Returns the nodes that may touch, ascending, and their degrees of freedom.
  const std::vector<int>& nodes() const { return nodes_; }
  const std::vector<int>& dofs() const { return dofs_; }
  /// Returns the basis at these nodes, three rows for each.
  const Eigen::MatrixXd& basis() const { return basis_; }
  /// Returns the place of a node's first degree of freedom in dofs().
  int place(int node) const { return places_[static_cast<std::size_t>(node)]; }

  /// The static response at one theta: that of `unit` divided by `ratio`.
  struct Flexibility {
    std::shared_ptr<const NodalFlexibility> unit;
    double ratio;
  };
  /// Returns the static response at theta. The last few are kept.
  Flexibility flexibility(const Eigen::VectorXd& theta) const;

 private:
  ReducedModel reduced_;
  std::vector<int> nodes_, dofs_, places_;
  Eigen::MatrixXd basis_;
  mutable std::mutex mutex_;
  mutable std::vector<std::shared_ptr<const NodalFlexibility>> known_;
};

}  // namespace tissue_stiffness
