#include "tissue_stiffness/forward/first_order_model.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "tissue_stiffness/forward/extra_force.hpp"
#include "tissue_stiffness/forward/reduced_trajectory.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kForceStep = 0.005;  // [s] at most between two looks at the force
constexpr double kLeastShare = 0.5;   // of the span that advance() is asked for, likewise

class FirstOrderTrajectory : public Trajectory {
 public:
  FirstOrderTrajectory(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start)
      : reduced_(reduced),
        extra_(reduced.model(), theta),
        linear_(reduced, theta, start),
        modes_(reduced.modes(theta)),
        step_(linear_.step()),
        state_(Eigen::MatrixXd::Zero(modes_->square.size(), step_.states())),
        force_(Eigen::VectorXd::Zero(modes_->square.size())) {}

  void advance(double time) override {
    const double span = time - linear_.time();
    if (extra_.absent() || !(span > 0.0)) {
      linear_.advance(time);
      return;
    }
    const double start = linear_.time(), longest = std::min(kForceStep, kLeastShare * span);
    const int steps = static_cast<int>(std::ceil(span / longest * (1.0 - 1e-9)));
    std::vector<Instant> instants;
    for (int k = 1; k <= steps; ++k) {
      const double now = k == steps ? time : start + span * k / steps;
      linear_.advance(now);
      instants.push_back({now, linear_.coordinates(), linear_.velocity(), {}});
    }
    tbb::parallel_for(std::size_t{0}, instants.size(), [&](std::size_t k) {
      Instant& i = instants[k];
      const Eigen::VectorXd u = reduced_.basis() * i.coordinates;
      i.force = modes_->shapes.transpose() * (reduced_.basis().transpose() * extra_(i.time, u, i.velocity));
    });
    for (Instant& i : instants) {
      step_.advance(span / steps, force_, i.force, state_);
      force_ = std::move(i.force);
    }
  }
  double time() const override { return linear_.time(); }
  Eigen::VectorXd displacement() const override {
    return reduced_.displacement(linear_.coordinates() + modes_->shapes * state_.col(0));
  }
  Eigen::VectorXd velocity() const override {
    return linear_.velocity() + reduced_.basis() * (modes_->shapes * state_.col(1));
  }

 private:
  struct Instant {
    double time;
    Eigen::VectorXd coordinates, velocity, force;
  };

  const ReducedModel& reduced_;
  ExtraForce extra_;
  ReducedTrajectory linear_;
  std::shared_ptr<const ReducedModes> modes_;
  ModalStep step_;
  Eigen::MatrixXd state_;  ///< response: columns q, q', z...; a row a mode
  Eigen::VectorXd force_;
};

BasisOptions at_first_order(BasisOptions options) {
  options.nonlinear = BasisOptions::Nonlinear::first_order;
  return options;
}

}  // namespace

FirstOrderModel::FirstOrderModel(const Model& model, const BasisOptions& options, const ReducedModel* relative)
    : reduced_(model, at_first_order(options), relative) {}

std::unique_ptr<Trajectory> FirstOrderModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<FirstOrderTrajectory>(reduced_, theta, start);
}

std::string FirstOrderModel::description() const {
  return reduced_.description() + ", nonlinear effects at first order";
}

}  // namespace tissue_stiffness
