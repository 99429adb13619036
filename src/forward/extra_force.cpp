#include "forward/extra_force.hpp"

#include <algorithm>

#include "forward/basis_seed_vectors.hpp"

namespace tissue_stiffness {
namespace {

double finite_share(const Model::Point& at) {
  double share = 0.0;
  for (const Model::Point::Part& part : at.parts) share = std::max(share, part.finite_share);
  return share;
}

Eigen::VectorXd without_extra_force(const Model& model, Eigen::VectorXd theta) {
  for (std::size_t p = 0; p < model.parts().size(); ++p) {
    if (adds_extra_force(model.parts()[p])) theta = theta_without_part(model, p, theta);
  }
  return theta;
}

}  // namespace

bool adds_extra_force(const Model::Part& part) {
  const LinearTerms& terms = part.terms;
  const bool only_finite = part.effect->finite_strain() != nullptr && terms.stiffness.empty() &&
                           terms.strain_stiffness.empty() && terms.loads.empty();
  return only_finite || part.effect->nonlinear_force() != nullptr || !terms.finite_share.empty();
}

bool has_linear_form(const Model::Part& part) {
  return part.effect->nonlinear_force() == nullptr || part.effect->finite_strain() != nullptr;
}

ExtraForce::ExtraForce(const Model& model, const Eigen::VectorXd& theta) : model_(model), with_(model.point(theta)) {
  const Eigen::VectorXd without = without_extra_force(model, theta);
  without_ = model.point(without);
  absent_ = theta == without;
  for (const Model::Part& part : model.parts()) {
    loaded_ = loaded_ || (part.effect->finite_strain() != nullptr && !part.terms.loads.empty());
  }
  even_ = finite_share(with_) != finite_share(without_);
}

Eigen::VectorXd ExtraForce::difference(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Eigen::VectorXd with = Eigen::VectorXd::Zero(u.size()), rest = with;
  model_.add_nonlinear_force(with_, {time, u, v}, with);
  model_.add_nonlinear_force(without_, {time, u, v}, rest);
  return with - rest;
}

Eigen::VectorXd ExtraForce::operator()(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  if (!even_) return difference(time, u, v);
  Eigen::VectorXd even = 0.5 * (difference(time, u, v) + difference(time, -u, -v));
  if (loaded_) even -= difference(time, Eigen::VectorXd::Zero(u.size()), v);
  return even;
}

}  // namespace tissue_stiffness
