#include "forward/force_change.hpp"

#include <utility>

#include "fem/products.hpp"
#include "fem/relaxation.hpp"

namespace tissue_stiffness {

UnchangedForces::UnchangedForces(const Model& of, const Eigen::VectorXd& at)
    : model(of), theta(at), system(of, at), stiffness(of.stiffness(at)), point(of.point(at)) {}

ForceChange::ForceChange(const UnchangedForces& unchanged, const Eigen::VectorXd& moved, double step)
    : unchanged_(unchanged), step_(step), point_(unchanged.model.point(moved)) {
  const Model& model = unchanged.model;
  const ModelSystem& rest = unchanged.system;
  auto now = std::make_unique<const ModelSystem>(model, moved);
  mass = difference(now->mass(), rest.mass());
  stiffness = difference(model.stiffness(moved), unchanged.stiffness);
  if (now->damped() || rest.damped()) {
    const SparseMatrix none = model.fem().pattern();
    damping = difference(now->damped() ? now->damping() : none, rest.damped() ? rest.damping() : none);
  }
  gravity = (now->gravity() - rest.gravity()) / step_;
  velocity = (model.initial_velocity(moved) - model.initial_velocity(unchanged.theta)) / step_;
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    laws = laws || model.nonlinear_part_changes(unchanged.point, point_, i);
    loads = loads || (!model.parts()[i].terms.loads.empty() && (point_.load_factor != unchanged.point.load_factor ||
                                                                !point_.parts[i].same(unchanged.point.parts[i])));
  }
  rates = point_.stiffness_damping != unchanged.point.stiffness_damping || !now->relaxations().empty();
  if (!now->relaxations().empty()) relaxing_ = std::move(now);
}

Eigen::VectorXd ForceChange::whole(const DynamicState& at) const {
  Eigen::VectorXd out = gravity + load(at.time) + nonlinear(at);
  if (mass.nonZeros() > 0) subtract_product(mass, at.acceleration, out);
  if (damping.nonZeros() > 0) subtract_product(damping, at.velocity, out);
  if (stiffness.nonZeros() > 0) subtract_product(stiffness, at.displacement, out);
  if (relaxes()) {
    const std::vector<Eigen::VectorXd> relaxed(branches().size(), Eigen::VectorXd::Zero(strain(at).size()));
    out += relaxation(at, relaxed);
  }
  return out;
}

Eigen::VectorXd ForceChange::load(double time) const {
  Eigen::VectorXd now = Eigen::VectorXd::Zero(gravity.size()), before = now;
  if (!loads) return now;
  unchanged_.model.add_loads(point_, time, now);
  unchanged_.model.add_loads(unchanged_.point, time, before);
  return (now - before) / step_;
}

Eigen::VectorXd ForceChange::nonlinear(const DynamicState& at) const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(gravity.size());
  unchanged_.model.add_nonlinear_change(unchanged_.point, point_, {at.time, at.displacement, at.velocity}, out);
  return out / step_;
}

Eigen::VectorXd ForceChange::strain(const DynamicState& at) const {
  Eigen::VectorXd out;
  relaxing_->find_relaxing_strain(at.displacement, out);
  return out;
}

Eigen::VectorXd ForceChange::relaxation(const DynamicState& at, const std::vector<Eigen::VectorXd>& relaxed) const {
  Eigen::VectorXd stretch, out = Eigen::VectorXd::Zero(gravity.size());
  overstretch(branches(), strain(at), relaxed, stretch);
  relaxing_->subtract_relaxing_force(at.displacement, stretch, out);
  return out / step_;
}

SparseMatrix ForceChange::difference(const SparseMatrix& now, const SparseMatrix& before) const {
  SparseMatrix out = now - before;
  out.prune([](Eigen::Index, Eigen::Index, double value) { return value != 0.0; });
  out /= step_;
  return out;
}

}  // namespace tissue_stiffness
