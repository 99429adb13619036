#include "tissue_stiffness/forward/extra_force.hpp"

#include <algorithm>
#include <utility>

#include "tissue_stiffness/forward/motive_terms.hpp"

namespace tissue_stiffness {
namespace {

double finite_share(const Model& model, const Eigen::VectorXd& theta) {
  double share = 0.0;
  for (const Model::Part& part : model.parts()) share = std::max(share, model.finite_share(part, theta));
  return share;
}

}  // namespace

bool adds_extra_force(const Model::Part& part) {
  return part.effect->nonlinear() || !part.terms.finite_share.empty();
}

ExtraForce::ExtraForce(const Model& model, Eigen::VectorXd theta)
    : model_(model), theta_(std::move(theta)), without_(theta_) {
  for (std::size_t p = 0; p < model.parts().size(); ++p) {
    if (adds_extra_force(model.parts()[p])) without_ = without(model, p, without_);
  }
  for (const Model::Part& part : model.parts()) {
    loaded_ = loaded_ || (part.effect->has_finite_form() && !part.terms.loads.empty());
  }
  even_ = finite_share(model, theta_) != finite_share(model, without_);
}

Eigen::VectorXd ExtraForce::difference(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Eigen::VectorXd with = Eigen::VectorXd::Zero(u.size()), rest = with;
  model_.add_nonlinear_force(theta_, {time, u, v}, with);
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
