#include "forward/hyper_reduced_system.hpp"

#include "fem/products.hpp"

namespace tissue_stiffness {
namespace {

using Nine = Eigen::Matrix<double, 9, 1>;

Eigen::Map<const Eigen::Matrix3d> tensor(const Eigen::VectorXd& all, std::size_t point) {
  return Eigen::Map<const Eigen::Matrix3d>(all.data() + 9 * point);
}

}  // namespace

HyperReducedSystem::HyperReducedSystem(const HyperReducedModel& reduced, const Eigen::VectorXd& theta)
    : reduced_(reduced), at_(reduced.model().point(theta)) {
  const Model& model = reduced.model();
  const Eigen::Index m = reduced.basis().vectors.cols();
  mass_ = damping_ = stiffness_ = Eigen::MatrixXd::Zero(m, m);
  gravity_ = Eigen::VectorXd::Zero(m);
  beta_ = model.stiffness_damping(theta);
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    add_part(i, theta);
    add_loads(i);
  }
  const auto points = static_cast<Eigen::Index>(reduced.basis().points.size());
  stresses_.resize(9 * points);
  weighted_.resize(9 * points, m);
  if (viscous_) weighted_rates_.resize(9 * points, m);
}

void HyperReducedSystem::add_part(std::size_t i, const Eigen::VectorXd& theta) {
  const Model& model = reduced_.model();
  const ModelPart& part = model.parts()[i];
  const HyperReducedModel::Projected& own = reduced_.projected()[i];
  const Eigen::VectorXd& p = at_.parts[i].parameters;
  const double share = at_.parts[i].finite_share, factor = model.mass_factor(theta),
               inertia = model.stiffness_inertia(theta);
  const FiniteStrainForm* form = part.effect->finite_strain();
  const bool turns = form != nullptr && form->has_strain_form();
  for (std::size_t k = 0; k < own.mass.size(); ++k) {
    const double c = factor * part.terms.mass[k].coefficient(p);
    mass_ += c * own.mass[k];
    damping_ += model.mass_damping(theta) * c * own.mass[k];
    gravity_ += c * (own.weight[k] * model.body_acceleration(theta));
  }
  for (std::size_t k = 0; k < own.stiffness.size(); ++k) {
    const MatrixTerm& term = part.terms.stiffness[k];
    const double c = term.coefficient(p);
    stiffness_ += (1.0 - share) * c * own.stiffness[k];
    if (!term.relaxes) continue;
    damping_ += beta_ * (turns ? 1.0 - share : 1.0) * c * own.stiffness[k];
    mass_ += inertia * c * own.stiffness[k];
  }
  if (form == nullptr || share == 0.0) return;
  if (form->follower_load() != nullptr) {
    followers_.push_back({&*own.follower, form->follower_load(), p, share, 0.0});
    return;
  }
  laws_.push_back({form->point_form(), p, share, turns ? share * beta_ : 0.0});
  viscous_ = viscous_ || laws_.back().viscosity > 0.0;
}

void HyperReducedSystem::add_loads(std::size_t i) {
  const std::vector<LoadTerm>& terms = reduced_.model().parts()[i].terms.loads;
  const Model::Point::Part& own = at_.parts[i];
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const double factor = (1.0 - own.finite_share) * terms[k].coefficient(own.parameters);
    loads_.push_back({&terms[k], i, factor,
                      terms[k].shaped ? Eigen::VectorXd(reduced_.basis().vectors.transpose() * own.shaped[k])
                                      : reduced_.projected()[i].loads[k]});
  }
}

void HyperReducedSystem::deform(const Eigen::VectorXd& q) {
  deformation_.noalias() = reduced_.basis().gradients * q;
  for (Eigen::Index k = 0; k < deformation_.size(); k += 9) {
    for (int i = 0; i < 3; ++i) deformation_[k + 4 * i] += 1.0;
  }
}

Lame HyperReducedSystem::viscosity(const Law& law, const SampledPoint& point) const {
  const Lame rest = law.form->rest_moduli(point.element, point.point, law.parameters);
  return {law.viscosity * rest.lambda, law.viscosity * rest.mu};
}

void HyperReducedSystem::force(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& rate, Eigen::VectorXd& out) {
  const HyperBasis& basis = reduced_.basis();
  out = gravity_;
  out.noalias() -= stiffness_ * q;
  out.noalias() -= damping_ * rate;
  for (const Load& load : loads_) {
    const Eigen::VectorXd& p = at_.parts[load.part].parameters;
    out += load.factor * reduced_.model().loads().value(*load.term, p, at_.load_factor, time) * load.pattern;
  }
  for (Follower& follower : followers_) {
    follower.now = follower.share * follower.load->size(time, at_.load_factor, follower.parameters);
    follower.force->add_force(follower.now, q, out);
  }
  deform(q);
  if (viscous_) rates_.noalias() = basis.gradients * rate;
  for (std::size_t k = 0; k < basis.points.size(); ++k) {
    const SampledPoint& point = basis.points[k];
    const Eigen::Matrix3d f = tensor(deformation_, k);
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    for (const Law& law : laws_) {
      Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
      law.form->add_stress(point.element, point.point, f, law.parameters, own);
      stress += law.share * own;
      if (law.viscosity > 0.0) stress += viscous_stress(viscosity(law, point), f, tensor(rates_, k));
    }
    Eigen::Map<Eigen::Matrix3d>(stresses_.data() + 9 * k) = point.weight * stress;
  }
  out.noalias() -= basis.gradients.transpose() * stresses_;
}

void HyperReducedSystem::tangents(const Eigen::VectorXd& q, Eigen::MatrixXd& stiffness, Eigen::MatrixXd& damping) {
  const HyperBasis& basis = reduced_.basis();
  deform(q);
  for (std::size_t k = 0; k < basis.points.size(); ++k) {
    const SampledPoint& point = basis.points[k];
    const Eigen::Matrix3d f = tensor(deformation_, k);
    StressTangent sum = StressTangent::Zero(), viscous = sum;
    for (const Law& law : laws_) {
      StressTangent own = StressTangent::Zero();
      law.form->add_tangent(point.element, point.point, f, law.parameters, own);
      sum += law.share * own;
      if (law.viscosity > 0.0) viscous += viscous_tangent(viscosity(law, point), f);
    }
    const auto row = static_cast<Eigen::Index>(9 * k);
    weighted_.middleRows<9>(row).noalias() = (point.weight * sum) * basis.gradients.middleRows<9>(row);
    if (viscous_)
      weighted_rates_.middleRows<9>(row).noalias() = (point.weight * viscous) * basis.gradients.middleRows<9>(row);
  }
  stiffness = stiffness_ + inner_products(basis.gradients, weighted_);
  for (const Follower& follower : followers_) follower.force->add_stiffness(follower.now, q, stiffness);
  damping = damping_;
  if (viscous_) damping += inner_products(basis.gradients, weighted_rates_);
}

}  // namespace tissue_stiffness
