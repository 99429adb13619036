#include "forward/first_order_model.hpp"

#include "forward/extra_force.hpp"
#include "forward/for_each_index.hpp"
#include "forward/force_steps.hpp"
#include "forward/reduced_trajectory.hpp"

namespace tissue_stiffness {
namespace {

class FirstOrderTrajectory : public Trajectory {
 public:
  FirstOrderTrajectory(const ReducedModel& reduced, const PackedMatrix& basis, const PackedMatrix& transposed,
                       const Eigen::VectorXd& theta, double start)
      : reduced_(reduced),
        basis_(basis),
        transposed_(transposed),
        extra_(reduced.model(), theta),
        linear_(reduced, theta, start),
        modes_(linear_.modes()),
        step_(linear_.step()),
        state_(Eigen::MatrixXd::Zero(modes_->square.size(), step_.states())),
        force_(Eigen::VectorXd::Zero(modes_->square.size())) {}

  void advance(double time) override {
    const double span = time - linear_.time();
    if (extra_.absent() || !(span > 0.0)) {
      linear_.advance(time);
      return;
    }
    const double start = linear_.time();
    const int steps = force_steps(span);
    std::vector<double> times;
    Eigen::MatrixXd coordinates(reduced_.basis().cols(), 2 * steps), modal_velocities(force_.size(), steps);
    for (int k = 0; k < steps; ++k) {
      times.push_back(k + 1 == steps ? time : start + span * (k + 1) / steps);
      linear_.advance(times.back());
      coordinates.col(k) = linear_.coordinates();
      modal_velocities.col(k) = linear_.modal_velocity();
    }
    // All instants at once, so that the basis is read from memory but twice.
    coordinates.rightCols(steps) = modes_->shapes * modal_velocities;
    const Eigen::MatrixXd motion = basis_ * coordinates;
    Eigen::MatrixXd forces(motion.rows(), steps);
    for_each_index(times.size(), [&](std::size_t i) {
      const auto k = static_cast<Eigen::Index>(i);
      forces.col(k) = extra_(times[i], motion.col(k), motion.col(steps + k));
    });
    const Eigen::MatrixXd modal = modes_->shapes.transpose() * (transposed_ * forces);
    for (int k = 0; k < steps; ++k) {
      step_.advance(span / steps, force_, modal.col(k), state_);
      force_ = modal.col(k);
    }
  }
  double time() const override { return linear_.time(); }
  Eigen::VectorXd displacement() const override { return reduced_.displacement(coordinates()); }
  Eigen::VectorXd reactions() const { return linear_.reactions_with(state_); }
  Eigen::VectorXd output() const override {
    Eigen::VectorXd out(reduced_.model().output_size());
    const Eigen::VectorXd forces = reactions();
    out << displacement(), forces;
    return out;
  }
  Eigen::VectorXd coordinates() const { return linear_.coordinates() + modes_->shapes * state_.col(0); }
  Eigen::VectorXd velocity() const override {
    return linear_.velocity() + reduced_.basis() * (modes_->shapes * state_.col(1));
  }

 private:
  const ReducedModel& reduced_;
  const PackedMatrix &basis_, &transposed_;
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
    : reduced_(model, at_first_order(options), relative),
      basis_(reduced_.basis()),
      transposed_(reduced_.basis().transpose()) {}

std::unique_ptr<Trajectory> FirstOrderModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<FirstOrderTrajectory>(reduced_, basis_, transposed_, theta, start);
}

void FirstOrderModel::advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const {
  reduced_.show_together(dynamic_cast<FirstOrderTrajectory&>(run), times, show);
}

std::string FirstOrderModel::description() const {
  return reduced_.description() + ", nonlinear effects at first order";
}

}  // namespace tissue_stiffness
