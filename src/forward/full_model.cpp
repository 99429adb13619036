#include "tissue_stiffness/forward/full_model.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "tissue_stiffness/fem/central_difference.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTolerance = 1e-5;  // last Newton correction over the body's size
constexpr double kExplicitSteps =
    250;  // explicit steps that one call of advance() may take before implicit ones are cheaper

double body_size(const TetMesh& mesh) {
  return (mesh.nodes.rowwise().maxCoeff() - mesh.nodes.rowwise().minCoeff()).norm();
}

class FullTrajectory : public Trajectory {
 public:
  FullTrajectory(const Model& model, const Eigen::VectorXd& theta, double start, const FullModel::Options& options)
      : options_(options),
        system_(model, theta),
        newmark_(system_, options.spectral_radius, kTolerance * body_size(model.mesh())) {
    const Eigen::Index n = model.fem().dof_count();
    state_.time = start;
    state_.displacement = Eigen::VectorXd::Zero(n);
    state_.velocity = model.initial_velocity(theta).replicate(n / 3, 1);
    for (Eigen::Index i = 0; i < n; ++i) {
      if (model.fixed()[static_cast<std::size_t>(i)] != 0) state_.velocity[i] = 0.0;
    }
  }

  void advance(double time) override {
    const double span = time - state_.time;
    if (!(span > 0.0)) return;
    if (!chosen_) choose(span);
    explicit_steps_ ? central_->advance(state_, span) : implicit(span);
    state_.time = time;
  }
  double time() const override { return state_.time; }
  Eigen::VectorXd displacement() const override { return state_.displacement; }
  Eigen::VectorXd velocity() const override { return state_.velocity; }

 private:
  // Impacts are filmed so fast that a few explicit steps reach the next frame.
  void choose(double span) {
    chosen_ = true;
    central_ = std::make_unique<CentralDifference>(system_, state_.time);
    explicit_steps_ = options_.step <= 0.0 && span < kExplicitSteps * central_->largest_step();
    explicit_steps_ ? central_->initialise(state_) : newmark_.initialise(state_);
  }

  void implicit(double span) {
    const int steps =
        options_.step > 0.0 ? static_cast<int>(std::ceil(span / options_.step * (1.0 - 1e-9))) : options_.steps_per_frame;
    for (int k = 0; k < steps; ++k) newmark_.step(state_, span / steps);
  }

  FullModel::Options options_;
  ModelSystem system_;
  Newmark newmark_;
  std::unique_ptr<CentralDifference> central_;
  DynamicState state_;
  bool chosen_ = false, explicit_steps_ = false;
};

}  // namespace

std::unique_ptr<Trajectory> FullModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<FullTrajectory>(model_, theta, start, options_);
}

std::string FullModel::description() const {
  const std::string scheme = options_.spectral_radius < 1.0 ? "generalised-alpha" : "Newmark";
  const std::string step =
      options_.step > 0.0 ? std::to_string(options_.step) + " s a step"
                          : std::to_string(options_.steps_per_frame) + " steps a frame (explicit when fewer than " +
                                std::to_string(static_cast<int>(kExplicitSteps)) + " stable steps span the first frame)";
  return "full: " + std::to_string(model_.fem().dof_count()) + " degrees of freedom, " + scheme + ", " + step;
}

ModelSystem::ModelSystem(const Model& model, Eigen::VectorXd theta)
    : model_(model),
      theta_(std::move(theta)),
      mass_(model.mass(theta_)),
      stiffness_(model.stiffness(theta_)),
      fixed_(model.fixed(theta_)),
      relaxations_(model.relaxations(theta_)) {
  const double alpha = model.mass_damping(theta_), beta = model.stiffness_damping(theta_);
  linear_part_ = stiffness_.coeffs().cwiseAbs().maxCoeff() > 0.0;
  damped_ = alpha > 0.0 || beta > 0.0;
  if (beta > 0.0 || !relaxations_.empty()) reference_ = model.reference_stiffness(theta_);
  if (damped_) {
    damping_ = alpha * mass_;
    if (beta > 0.0) damping_ += beta * reference_;
  }
  gravity_ = mass_ * model.body_acceleration(theta_).replicate(mass_.rows() / 3, 1);
}

Eigen::VectorXd ModelSystem::force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Eigen::VectorXd f = gravity_;
  if (linear_part_) f -= stiffness_ * u;
  model_.add_loads(theta_, time, f);
  model_.add_nonlinear_force(theta_, {time, u, v}, f);
  return f;
}

SparseMatrix ModelSystem::stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  SparseMatrix k = stiffness_;
  model_.add_nonlinear_stiffness(theta_, {time, u, v}, k);
  return k;
}

double ModelSystem::energy(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  return 0.5 * v.dot(mass_ * v) + model_.stored_energy(theta_, {time, u, v}) - gravity_.dot(u);
}

}  // namespace tissue_stiffness
