#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/fem/products.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"

namespace tissue_stiffness {

/// What effects that are not linear would do, at first order: a run of the model's linear rest, and its response to the
/// force that those effects exert along this run. Of finite strain only the part of the force that is even in the
/// displacement counts, (f(u) + f(-u)) / 2: small strain turns rotations into stretch, which the odd part would resist.
/// What has no absent value (a law of finite strain) counts as linear. Little dearer than a linear run, for tangents.
class FirstOrderModel : public ForwardModel {
 public:
  /// Throws InputError for a model that nothing moves.
  /// `relative` as ReducedModel has it.
  explicit FirstOrderModel(const Model& model, const BasisOptions& options = {}, const ReducedModel* relative = nullptr);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  void advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const override;
  void focus(const std::vector<int>& nodes) override { reduced_.focus(nodes); }
  std::string description() const override;

  const ReducedModel& reduced() const { return reduced_; }

 private:
  ReducedModel reduced_;
  PackedMatrix basis_, transposed_;
};

}  // namespace tissue_stiffness
