#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "forward/full_model.hpp"

namespace tissue_stiffness {

/// Runs in full with steps h and h / 2, whose difference tells the error of both. Both are of second order, so
///   u = (4 u(h / 2) - u(h)) / 3
/// is of fourth order (Richardson 1911; Hairer, Norsett & Wanner 1993, sec. II.4). A body that rings for long needs it: a
/// period that is off by a thousandth is out of phase after some hundred periods. A force that is not smooth, such as
/// contact, has no such expansion.
class ExtrapolatedModel : public ForwardModel {
 public:
  /// `options.step` is not used.
  ExtrapolatedModel(const Model& model, const FullModel::Options& options);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  std::string description() const override;

 private:
  FullModel coarse_, fine_;
};

}  // namespace tissue_stiffness
