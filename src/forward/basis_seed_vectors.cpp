#include "forward/basis_seed_vectors.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "effects/registry.hpp"
#include "forward/extra_force.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSameRatio = 1e-9;
constexpr double kModerate = 0.03;  // strain at which nonlinear effects are evaluated

void append(Eigen::MatrixXd& to, const Eigen::MatrixXd& columns) {
  to.conservativeResize(columns.rows(), to.cols() + columns.cols());
  to.rightCols(columns.cols()) = columns;
}

Eigen::VectorXd along(const Model& model, int axis) {
  Eigen::VectorXd u = Eigen::VectorXd::Zero(model.fem().dof_count());
  for (Eigen::Index i = axis; i < u.size(); i += 3) u[i] = 1.0;
  return u;
}

Eigen::Vector3d acceleration(const Model::Part& part, const Eigen::VectorXd& theta) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    for (const Coefficient& c : part.terms.acceleration[i]) sum[i] += c(part.parameters(theta));
  }
  return sum;
}

// Returns a part's parameters with one of those that shape a term changed by the view's reach, in both directions.
std::vector<Eigen::VectorXd> moved(const Model& model, const PriorView& prior, const Model::Part& part,
                                   const std::vector<int>& shape) {
  std::vector<Eigen::VectorXd> list;
  for (const int i : shape) {
    if (!model.estimated(part, {i})) continue;
    const int index = part.indices[static_cast<std::size_t>(i)];
    for (const double sign : {-1.0, 1.0}) {
      const double value = model.parameters().theta(prior.place + sign * prior.reach)[index];
      Eigen::VectorXd theta = prior.theta;
      theta[index] = value;
      list.push_back(part.parameters(theta));
    }
  }
  return list;
}

// Returns whether the term is absent at the parameters p, but not elsewhere.
template <typename Term>
bool is_inactive(const Term& term, const Eigen::VectorXd& p, const Eigen::VectorXd& elsewhere) {
  return term.coefficient(p) == 0.0 && term.coefficient(elsewhere) != 0.0;
}

}  // namespace

Eigen::VectorXd theta_without_part(const Model& model, std::size_t part, Eigen::VectorXd theta) {
  const std::vector<int>& indices = model.parts()[part].indices;
  std::size_t k = 0;
  for (const ParameterSpec& spec : effect_spec(model.settings().effects[part]).parameters) {
    for (int c = 0; c < spec.components; ++c, ++k) {
      if (std::isfinite(spec.absent)) theta[indices[k]] = spec.absent;
    }
  }
  return theta;
}

PriorView::PriorView(const Model& model, const Eigen::VectorXd& around, const Eigen::VectorXd& reach)
    : place(around.size() > 0 ? around : model.parameters().prior_mean()),
      reach(reach.size() > 0 ? reach : model.parameters().prior_std()),
      theta(model.parameters().theta(place)) {
  Eigen::VectorXd w = place;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    w[i] += (0.3 + 0.7 * std::fmod(0.618034 * static_cast<double>(i + 1), 1.0)) * this->reach[i];
  }
  generic = model.parameters().theta(w);
  for (std::size_t p = 0; p < model.parts().size(); ++p) {
    const auto& part = model.parts()[p];
    if (part.is_compliant(part.parameters(generic)) && model.estimated(part, {0}))
      theta = theta_without_part(model, p, theta);
  }
}

Eigen::MatrixXd acting_loads(const Model& model, const PriorView& prior, const SparseMatrix& mass) {
  Eigen::MatrixXd loads(mass.rows(), 0);
  const Eigen::Vector3d gravity = model.body_acceleration(prior.theta), other = model.body_acceleration(prior.generic);
  const bool turns = gravity.cross(other).norm() > kSameRatio * gravity.norm() * other.norm();
  if (gravity.norm() > 0.0) {
    if (turns) {
      for (int i = 0; i < 3; ++i) append(loads, mass * along(model, i));
    } else {
      append(loads, mass * gravity.replicate(mass.rows() / 3, 1));
    }
  }
  for (const auto& part : model.parts()) {
    const Eigen::VectorXd p = part.parameters(prior.theta);
    for (const auto& term : part.terms.loads) {
      if (term.coefficient(p) != 0.0) append(loads, term.shaped ? term.shaped(p) : term.pattern);
    }
  }
  for (const auto& part : model.parts()) {
    const Contact* contact = part.effect->contact();
    if (contact == nullptr) continue;
    for (int i = 0; i < 3; ++i) {
      append(loads, Eigen::VectorXd::Zero(mass.rows()));
      for (const int node : contact->nodes()) loads(3 * node + i, loads.cols() - 1) = 1.0;
    }
  }
  if (model.settings().initial.kind == InitialSettings::Kind::rest && !model.starts_in_motion()) return loads;
  for (int i = 0; i < 3; ++i) {
    Eigen::VectorXd push = along(model, i);
    for (Eigen::Index k = 0; k < push.size(); ++k) {
      if (model.fixed()[static_cast<std::size_t>(k)] != 0) push[k] = 0.0;
    }
    append(loads, mass * push);
  }
  return loads;
}

Eigen::MatrixXd inactive_loads(const Model& model, const PriorView& prior, const SparseMatrix& mass, std::size_t index) {
  Eigen::MatrixXd loads(mass.rows(), 0);
  const auto& part = model.parts()[index];
  const Eigen::VectorXd p = part.parameters(prior.theta), generic = part.parameters(prior.generic);
  if (acceleration(part, prior.theta).isZero(0.0) && !acceleration(part, prior.generic).isZero(0.0)) {
    for (int i = 0; i < 3; ++i) append(loads, mass * along(model, i));
  }
  for (const auto& term : part.terms.loads) {
    if (term.coefficient(generic) == 0.0) continue;
    if (term.coefficient(p) == 0.0) append(loads, term.shaped ? term.shaped(p) : term.pattern);
    if (!term.shaped) continue;
    for (const Eigen::VectorXd& q : moved(model, prior, part, term.shape)) append(loads, term.shaped(q));
  }
  return loads;
}

std::vector<SparseMatrix> stiffness_groups(const Model& model, const PriorView& prior) {
  using Addend = std::function<void(SparseMatrix&)>;
  std::vector<std::pair<double, std::vector<Addend>>> groups;  // ratio to the other place, what it sums
  const auto sort_in = [&](double ratio, Addend addend) {
    for (auto& known : groups) {
      if (std::abs(known.first - ratio) < kSameRatio * std::abs(ratio)) return known.second.push_back(std::move(addend));
    }
    groups.push_back({ratio, {std::move(addend)}});
  };
  for (const auto& part : model.parts()) {
    const Eigen::VectorXd p = part.parameters(prior.theta), generic = part.parameters(prior.generic);
    for (const auto& term : part.terms.stiffness) {
      const double c = term.coefficient(p);
      if (c == 0.0) continue;
      sort_in(term.coefficient(generic) / c, [c, &term](SparseMatrix& k) { add_scaled(k, c, *term.matrix); });
    }
    for (const auto& term : part.terms.strain_stiffness) {
      const double c = term.coefficient(p);
      if (c == 0.0) continue;
      sort_in(term.coefficient(generic) / c,
              [&model, c, p, &term](SparseMatrix& k) { add_strain_stiffness(model.fem(), term.at(p), c, k); });
    }
  }
  std::vector<SparseMatrix> sums;
  if (groups.size() < 2) return sums;
  for (const auto& known : groups) {
    sums.push_back(model.fem().pattern());
    for (const Addend& add_to : known.second) add_to(sums.back());
  }
  return sums;
}

std::vector<SparseMatrix> inactive_stiffness(const Model& model, const PriorView& prior) {
  std::vector<SparseMatrix> list;
  for (const auto& part : model.parts()) {
    if (!part.compliant_nodes().empty()) continue;
    const Eigen::VectorXd p = part.parameters(prior.theta), generic = part.parameters(prior.generic);
    SparseMatrix sum = model.fem().pattern();
    bool any = false;
    for (const auto& term : part.terms.stiffness) {
      if (!is_inactive(term, p, generic)) continue;
      add_scaled(sum, term.coefficient(generic), *term.matrix);
      any = true;
    }
    for (const auto& term : part.terms.strain_stiffness) {
      if (!is_inactive(term, p, generic)) continue;
      add_strain_stiffness(model.fem(), term.at(p), term.coefficient(generic), sum);
      any = true;
    }
    if (any) list.push_back(std::move(sum));
  }
  return list;
}

bool answers_motion(const Model& model, const PriorView& prior, std::size_t index) {
  const auto& part = model.parts()[index];
  const Eigen::VectorXd p = part.parameters(prior.theta), generic = part.parameters(prior.generic);
  const auto any = [&](const auto& terms) {
    return std::any_of(terms.begin(), terms.end(), [&](const auto& term) { return is_inactive(term, p, generic); });
  };
  const auto moves = [&](const StrainTerm& term) { return model.estimated(part, term.shape); };
  const std::vector<StrainTerm>& strained = part.terms.strain_stiffness;
  return any(part.terms.stiffness) || any(part.terms.mass) || any(strained) ||
         std::any_of(strained.begin(), strained.end(), moves) || adds_extra_force(part);
}

Eigen::MatrixXd inactive_forces(const Model& model, const PriorView& prior, std::size_t index, const Eigen::MatrixXd& u,
                                const StrainRows& strains) {
  const auto& part = model.parts()[index];
  const Eigen::VectorXd p = part.parameters(prior.theta), generic = part.parameters(prior.generic);
  Eigen::MatrixXd forces(u.rows(), 0), sum = Eigen::MatrixXd::Zero(u.rows(), u.cols());
  for (const auto& term : part.terms.stiffness) {
    if (is_inactive(term, p, generic)) sum += term.coefficient(generic) * (*term.matrix * u);
  }
  for (const auto& term : part.terms.strain_stiffness) {
    if (is_inactive(term, p, generic)) {
      sum += term.coefficient(generic) * apply_strain_stiffness(model.fem(), term.at(p), strains);
    }
    if (term.coefficient(generic) == 0.0) continue;
    for (const Eigen::VectorXd& q : moved(model, prior, part, term.shape)) {
      append(forces, apply_strain_stiffness(model.fem(), term.at(q), strains));
    }
  }
  if (!sum.isZero(0.0)) append(forces, sum);
  for (const auto& term : part.terms.mass) {
    if (is_inactive(term, p, generic)) append(forces, *term.matrix * u);
  }
  return forces;
}

Eigen::MatrixXd extra_forces(const Model& model, const PriorView& prior, std::size_t index, const Eigen::MatrixXd& u,
                             const StrainRows& strains) {
  Eigen::MatrixXd forces(u.rows(), 0);
  const auto& part = model.parts()[index];
  if (!adds_extra_force(part) || u.cols() == 0) return forces;
  Eigen::VectorXd theta = prior.theta;
  for (const int i : part.indices) theta[i] = prior.generic[i];
  const ExtraForce extra(model, theta);
  const Eigen::VectorXd still = Eigen::VectorXd::Zero(u.rows());
  const double largest = strains.cwiseAbs().maxCoeff();
  const auto add_forces_of = [&](const Eigen::VectorXd& motion) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::VectorXd force = extra(model.loads().first_stamp(), sign * kModerate / largest * motion, still);
      if (!force.isZero(0.0)) append(forces, force);
    }
  };
  for (Eigen::Index i = 0; i < u.cols(); ++i) {
    add_forces_of(u.col(i));
    for (Eigen::Index j = 0; j < i; ++j) {
      add_forces_of(u.col(i) + u.col(j));
      add_forces_of(u.col(i) - u.col(j));
    }
  }
  return forces;
}

}  // namespace tissue_stiffness
