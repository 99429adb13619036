#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fem/generalized_alpha.hpp"
#include "forward/forward_model.hpp"
#include "forward/full_model.hpp"
#include "forward/output_rows.hpp"

namespace tissue_stiffness {

/// A model at first order about one of its own runs in full, however large that motion is:
///   u(theta, t) = u0(t) + sum_k (theta_k - theta0_k) s_k(t).
/// The sensitivities s_k solve the variational equation of the motion (Hairer, Norsett & Wanner 1993, sec. I.14)
///   M s_k'' + C(t) s_k' + K(t) s_k = d/dtheta_k [f(t, u0, v0) - C v0 - M a0]
/// in few vectors: those of the motion itself, and static responses K(t)^-1 of the deformed body to the right-hand sides.
/// Each instant of the run is a step. K(t), C(t) and what laws change are taken at some of them, and are linear between.
/// Thread safe.
class LinearisedModel : public ForwardModel {
 public:
  struct Options {
    std::size_t stride = 1;                 ///< instants from one at which matrices and laws are evaluated to the next
    int largest = 64;                       ///< vectors
    double spectral_radius = 0.9;           ///< of generalised-alpha at infinite frequency
    std::function<void()> checkpoint = {};  ///< called now and then; what it throws ends the construction
  };
  /// `run`: states at the start and at later instants, of the model at `theta`. `step`: how far each theta is moved for
  /// its right-hand side; 0: it is not moved. Throws InputError where why_not_linearised says so.
  LinearisedModel(const Model& model, const Eigen::VectorXd& theta, std::vector<DynamicState> run,
                  const Eigen::VectorXd& step, const Options& options);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  void restrict_output_to(const OutputNodes& nodes) override { output_.restrict_to(vectors_, nodes); }
  std::string description() const override;

  /// Returns the displacement of every node at an instant, 3n [m], and its rate [m/s].
  Eigen::VectorXd displacement(const Eigen::VectorXd& theta, double time) const;
  Eigen::VectorXd velocity(const Eigen::VectorXd& theta, double time) const;
  /// Returns the displacement with what theta changes at the nodes of the output alone.
  Eigen::VectorXd output(const Eigen::VectorXd& theta, double time) const;
  const Model& model() const { return model_; }

 private:
  class Builder;
  /// An instant, and how far a time is from it to the next one: 0 to 1, and more after the last.
  struct Place {
    std::size_t at;
    double part;
  };
  Place place(double time) const;
  Eigen::VectorXd motion(const Place& place) const;
  Eigen::VectorXd change(const Eigen::VectorXd& theta, const Place& place) const;

  const Model& model_;
  Eigen::VectorXd theta_;
  std::vector<DynamicState> run_;
  std::vector<Eigen::Index> moved_;             ///< indices of theta that have a sensitivity
  Eigen::MatrixXd vectors_;                     ///< 3n x m, M-orthonormal
  std::vector<Eigen::MatrixXd> sensitivities_;  ///< at each instant, m x moved
  OutputRows output_;
};

/// Returns why a model cannot be linearised about a run; empty: it can.
std::string why_not_linearised(const Model& model);
/// Returns the same for one of its parts beside others that can.
std::string why_not_linearised(const ModelPart& part);

}  // namespace tissue_stiffness
