#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "fem/products.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// Nonlinear effects at first order. The linear part of the model is run, and its response to the force of the nonlinear
/// effects along this run is added. Under finite strain only the even part of the force, (f(u) + f(-u)) / 2, is used. Small
/// strain turns rotations into stretch, and the odd part would resist this stretch. An effect without an absent value (a
/// law of finite strain) counts as linear. This costs little more than a linear run and is used for tangents.
class FirstOrderModel : public ForwardModel {
 public:
  /// `relative`: as in ReducedModel. Throws InputError for a model that nothing moves.
  explicit FirstOrderModel(const Model& model, const BasisOptions& options = {}, const ReducedModel* relative = nullptr);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  void advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const override;
  void restrict_output_to(const OutputNodes& nodes) override { reduced_.restrict_output_to(nodes); }
  std::string description() const override;

  const ReducedModel& reduced() const { return reduced_; }

 private:
  ReducedModel reduced_;
  PackedMatrix basis_, transposed_;
};

}  // namespace tissue_stiffness
