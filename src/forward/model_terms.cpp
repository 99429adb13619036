// This file computes the model's sums at theta.
#include <algorithm>
#include <functional>

#include "fem/facet_quadrature.hpp"
#include "fem/strain.hpp"
#include "forward/model.hpp"

namespace tissue_stiffness {
namespace {

using Terms = std::vector<Coefficient> LinearTerms::*;

double sum_of(const std::vector<Model::Part>& parts, const Eigen::VectorXd& theta, Terms terms) {
  double sum = 0.0;
  for (const Model::Part& part : parts) {
    for (const Coefficient& c : part.terms.*terms) sum += c(part.parameters(theta));
  }
  return sum;
}

double product_of(const std::vector<Model::Part>& parts, const Eigen::VectorXd& theta, Terms terms) {
  double product = 1.0;
  for (const Model::Part& part : parts) {
    for (const Coefficient& c : part.terms.*terms) product *= c(part.parameters(theta));
  }
  return product;
}

void add(SparseMatrix& to, double scale, const MatrixTerm& term) {
  if (scale != 0.0) add_scaled(to, scale, *term.matrix);
}

bool has_strain_form(const Model::Part& part) {
  const FiniteStrainForm* form = part.effect->finite_strain();
  return form != nullptr && form->has_strain_form();
}

// Returns the share of a part's stress that is linear in a finite strain.
double strain_share(const Model::Part& part, const Model::Point::Part& at) {
  return has_strain_form(part) ? at.finite_share : 0.0;
}

}  // namespace

std::vector<char> Model::fixed(const Eigen::VectorXd& theta) const {
  std::vector<int> holders = constraint_count_;
  for (const Part& part : parts_) {
    if (!part.is_compliant(part.parameters(theta))) continue;
    for (const int node : part.compliant_nodes()) --holders[static_cast<std::size_t>(node)];
  }
  std::vector<char> flags(fixed_.size());
  for (std::size_t i = 0; i < flags.size(); ++i) flags[i] = holders[i / 3] > 0 ? 1 : 0;
  return flags;
}

bool Model::starts_in_motion() const {
  return std::any_of(parts_.begin(), parts_.end(), [this](const Part& part) {
    return part.terms.initial_motion &&
           (estimated(part) || !part.terms.initial_motion(part.parameters(prior_theta_)).none());
  });
}

InitialMotion Model::initial_motion(const Eigen::VectorXd& theta) const {
  InitialMotion sum;
  for (const Part& part : parts_) {
    if (!part.terms.initial_motion) continue;
    const InitialMotion own = part.terms.initial_motion(part.parameters(theta));
    sum.equilibrium += own.equilibrium;
    sum.displacement += own.displacement;
    sum.velocity += own.velocity;
  }
  return sum;
}

SparseMatrix Model::mass(const Eigen::VectorXd& theta) const {
  SparseMatrix m = fem().pattern();
  const double factor = mass_factor(theta);
  for (const Part& part : parts_) {
    if (part.terms.mass.empty()) continue;
    const Eigen::VectorXd p = part.parameters(theta);
    for (const MatrixTerm& term : part.terms.mass) add(m, factor * term.coefficient(p), term);
  }
  return m;
}

SparseMatrix Model::sum_stiffness(const Eigen::VectorXd& theta, bool all,
                                  const std::function<double(const Part&)>& share_of) const {
  SparseMatrix k = fem().pattern();
  for (const Part& part : parts_) {
    if (part.terms.stiffness.empty() && part.terms.strain_stiffness.empty()) continue;
    const double share = share_of(part);
    if (share == 0.0) continue;
    const Eigen::VectorXd p = part.parameters(theta);
    for (const MatrixTerm& term : part.terms.stiffness) {
      if (all || term.relaxes) add(k, share * term.coefficient(p), term);
    }
    for (const StrainTerm& term : part.terms.strain_stiffness) {
      const double scale = share * term.coefficient(p);
      if (scale != 0.0) add_strain_stiffness(fem(), term.at(p), scale, k);
    }
  }
  return k;
}

SparseMatrix Model::stiffness(const Eigen::VectorXd& theta) const {
  return sum_stiffness(theta, true, [&](const Part& part) { return 1.0 - finite_share(part, theta); });
}

SparseMatrix Model::rest_stiffness(const Eigen::VectorXd& theta) const {
  return sum_stiffness(theta, true, [](const Part&) { return 1.0; });
}

SparseMatrix Model::reference_stiffness(const Eigen::VectorXd& theta) const {
  return sum_stiffness(theta, false, [](const Part&) { return 1.0; });
}

SparseMatrix Model::linear_reference_stiffness(const Eigen::VectorXd& theta) const {
  return sum_stiffness(theta, false,
                       [&](const Part& part) { return has_strain_form(part) ? 1.0 - finite_share(part, theta) : 1.0; });
}

double Model::mass_damping(const Eigen::VectorXd& theta) const {
  return sum_of(parts_, theta, &LinearTerms::mass_damping);
}

double Model::stiffness_damping(const Eigen::VectorXd& theta) const {
  return sum_of(parts_, theta, &LinearTerms::stiffness_damping);
}

double Model::stiffness_inertia(const Eigen::VectorXd& theta) const {
  return sum_of(parts_, theta, &LinearTerms::stiffness_inertia);
}

double Model::mass_factor(const Eigen::VectorXd& theta) const {
  return product_of(parts_, theta, &LinearTerms::mass_factor);
}

double Model::load_factor(const Eigen::VectorXd& theta) const {
  return product_of(parts_, theta, &LinearTerms::load_factor);
}

std::vector<Relaxation> Model::relaxations(const Eigen::VectorXd& theta) const {
  std::vector<Relaxation> branches;
  for (const Part& part : parts_) {
    for (const RelaxationTerm& term : part.terms.relaxation) {
      const Eigen::VectorXd p = part.parameters(theta);
      const double modulus = term.modulus(p);
      if (modulus > 0.0) branches.push_back({modulus, term.time_constant(p)});
    }
  }
  return branches;
}

bool Model::same_answer(const Eigen::VectorXd& theta, const Eigen::VectorXd& other) const {
  for (const Part& part : parts_) {
    const Eigen::VectorXd p = part.parameters(theta), q = part.parameters(other);
    if (part.effect->nonlinear_force() != nullptr && p != q) return false;
    if (part.is_compliant(p) != part.is_compliant(q)) return false;
    for (const auto* terms : {&part.terms.mass, &part.terms.stiffness}) {
      for (const MatrixTerm& term : *terms) {
        if (term.coefficient(p) != term.coefficient(q)) return false;
      }
    }
    for (const StrainTerm& term : part.terms.strain_stiffness) {
      if (term.coefficient(p) != term.coefficient(q)) return false;
      for (const int i : term.shape) {
        if (p[i] != q[i]) return false;
      }
    }
    for (const RelaxationTerm& term : part.terms.relaxation) {
      if (term.modulus(p) != term.modulus(q) || term.time_constant(p) != term.time_constant(q)) return false;
    }
  }
  for (const auto value :
       {&Model::mass_factor, &Model::mass_damping, &Model::stiffness_damping, &Model::stiffness_inertia}) {
    if ((this->*value)(theta) != (this->*value)(other)) return false;
  }
  return sensors_.delay(theta) == sensors_.delay(other);
}

Eigen::Vector3d Model::body_acceleration(const Eigen::VectorXd& theta) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Part& part : parts_) {
    for (int i = 0; i < 3; ++i) {
      for (const Coefficient& c : part.terms.acceleration[i]) sum[i] += c(part.parameters(theta));
    }
  }
  return sum;
}

double Model::finite_share(const Part& part, const Eigen::VectorXd& theta) const {
  if (part.effect->finite_strain() == nullptr) return 0.0;
  return finite_law_ ? 1.0 : std::min(1.0, sum_of(parts_, theta, &LinearTerms::finite_share));
}

Model::Point Model::point(const Eigen::VectorXd& theta) const {
  Point at;
  at.load_factor = load_factor(theta);
  at.stiffness_damping = stiffness_damping(theta);
  for (const Part& part : parts_) {
    Point::Part own{part.parameters(theta), finite_share(part, theta), {}};
    for (const LoadTerm& term : part.terms.loads) {
      own.shaped.push_back(term.shaped ? term.shaped(own.parameters) : Eigen::VectorXd());
    }
    at.parts.push_back(std::move(own));
  }
  return at;
}

void Model::add_loads(const Point& at, double time, Eigen::VectorXd& force) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Point::Part& own = at.parts[i];
    const std::vector<LoadTerm>& terms = parts_[i].terms.loads;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const LoadTerm& term = terms[k];
      const double value = (1.0 - own.finite_share) * term.coefficient(own.parameters) *
                           loads_.value(term, own.parameters, at.load_factor, time);
      if (value != 0.0) force += value * (term.shaped ? own.shaped[k] : term.pattern);
    }
  }
}

Motion Model::seen_by(std::size_t part, const Point& at, Motion motion) const {
  motion.load_factor = at.load_factor;
  motion.since = motion.time - loads_.first_stamp();
  motion.finite_share = at.parts[part].finite_share;
  return motion;
}

void Model::add_part_force(const Point& at, std::size_t i, const Motion& general, Eigen::VectorXd& force) const {
  const Effect& effect = *parts_[i].effect;
  const Eigen::VectorXd& p = at.parts[i].parameters;
  const Motion motion = seen_by(i, at, general);
  if (const NonlinearForce* own = effect.nonlinear_force()) own->add_force(motion, p, force);
  const FiniteStrainForm* form = effect.finite_strain();
  if (motion.finite_share == 1.0) {
    form->add_finite_force(motion, p, force);
  } else if (motion.finite_share > 0.0) {
    VectorPool::Loan finite(scratch_, force.size());
    finite->setZero();
    form->add_finite_force(motion, p, *finite);
    force += motion.finite_share * *finite;
  }
}

void Model::add_nonlinear_force(const Point& at, Motion motion, Eigen::VectorXd& force) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) add_part_force(at, i, motion, force);
  if (!has_finite_damping(at)) return;
  VectorPool::Loan rates(scratch_, strain_count(fem()));
  green_strain_rates(fem(), motion.displacement, motion.velocity, *rates);
  *rates *= at.stiffness_damping;
  add_strain_force(at, motion.displacement, *rates, force);
}

bool Model::nonlinear_part_changes(const Point& from, const Point& to, std::size_t i) const {
  const FiniteStrainForm* form = parts_[i].effect->finite_strain();
  if (form == nullptr && parts_[i].effect->nonlinear_force() == nullptr) return false;
  const bool loaded = form != nullptr && form->follower_load() != nullptr;
  return !to.parts[i].same(from.parts[i]) || (loaded && to.load_factor != from.load_factor);
}

void Model::add_nonlinear_change(const Point& from, const Point& to, Motion motion, Eigen::VectorXd& force) const {
  Eigen::VectorXd before = Eigen::VectorXd::Zero(force.size()), rates;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const bool changed = nonlinear_part_changes(from, to, i);
    if (changed) {
      add_part_force(to, i, motion, force);
      add_part_force(from, i, motion, before);
    }
    const double damps = from.stiffness_damping * strain_share(parts_[i], from.parts[i]),
                 will = to.stiffness_damping * strain_share(parts_[i], to.parts[i]);
    if ((!changed && damps == will) || (damps == 0.0 && will == 0.0)) continue;
    if (rates.size() == 0) {
      rates.resize(strain_count(fem()));
      green_strain_rates(fem(), motion.displacement, motion.velocity, rates);
    }
    const FiniteStrainForm& form = *parts_[i].effect->finite_strain();
    if (will != 0.0) form.add_strain_force(motion.displacement, rates, to.parts[i].parameters, will, force);
    if (damps != 0.0) form.add_strain_force(motion.displacement, rates, from.parts[i].parameters, damps, before);
  }
  force -= before;
}

void Model::add_strain_force(const Point& at, const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains,
                             Eigen::VectorXd& force) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const double share = strain_share(parts_[i], at.parts[i]);
    if (share > 0.0) parts_[i].effect->finite_strain()->add_strain_force(u, strains, at.parts[i].parameters, share, force);
  }
}

void Model::add_nonlinear_stiffness(const Point& at, Motion general, SparseMatrix& stiffness) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Effect& effect = *parts_[i].effect;
    const Eigen::VectorXd& p = at.parts[i].parameters;
    const Motion motion = seen_by(i, at, general);
    if (const NonlinearForce* own = effect.nonlinear_force()) own->add_stiffness(motion, p, stiffness);
    const FiniteStrainForm* form = effect.finite_strain();
    if (motion.finite_share == 1.0) {
      form->add_finite_stiffness(motion, p, stiffness);
    } else if (motion.finite_share > 0.0) {
      SparseMatrix finite = fem().pattern();
      form->add_finite_stiffness(motion, p, finite);
      stiffness += motion.finite_share * finite;
    }
  }
}

bool Model::has_finite_damping(const Point& at) const {
  if (at.stiffness_damping == 0.0) return false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (strain_share(parts_[i], at.parts[i]) > 0.0) return true;
  }
  return false;
}

bool Model::may_be_finite() const {
  return finite_law_ ||
         std::any_of(parts_.begin(), parts_.end(), [](const Part& p) { return !p.terms.finite_share.empty(); });
}

bool Model::may_damp_by_stiffness() const {
  return std::any_of(parts_.begin(), parts_.end(), [](const Part& p) {
    return !p.terms.stiffness_damping.empty() || !p.terms.stiffness_inertia.empty();
  });
}

bool Model::has_friction(const Point& at) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const NonlinearForce* force = parts_[i].effect->nonlinear_force();
    if (force != nullptr && force->has_velocity_tangent(at.parts[i].parameters)) return true;
  }
  return false;
}

void Model::add_velocity_tangent(const Point& at, Motion motion, SparseMatrix& damping) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Eigen::VectorXd& p = at.parts[i].parameters;
    const NonlinearForce* force = parts_[i].effect->nonlinear_force();
    if (force != nullptr && force->has_velocity_tangent(p)) force->add_velocity_tangent(motion, p, damping);
    const double beta = at.stiffness_damping * strain_share(parts_[i], at.parts[i]);
    if (beta > 0.0) parts_[i].effect->finite_strain()->add_strain_tangent(motion.displacement, p, beta, damping);
  }
}

// The prescribed loads and the springs of a part share one coefficient.
Eigen::Vector3d Model::spring_reaction(const Reaction& reaction, const Point::Part& own, const Motion& motion) const {
  const LinearTerms& terms = parts_[reaction.part].terms;
  const double stiffness = terms.stiffness.front().coefficient(own.parameters);
  Eigen::Vector3d force = -stiffness * (reaction.springs.transpose() * motion.displacement);
  for (const LoadTerm& term : terms.loads) {
    const double value = term.coefficient(own.parameters) * loads_.value(term, own.parameters, 1.0, motion.time);
    force += value * resultant(term.pattern);
  }
  return force;
}

void Model::find_reactions(const Point& at, const Motion& motion, Eigen::Ref<Eigen::VectorXd> out) const {
  for (std::size_t r = 0; r < reactions_.size(); ++r) {
    const Reaction& reaction = reactions_[r];
    const Point::Part& own = at.parts[reaction.part];
    auto force = out.segment<3>(3 * static_cast<Eigen::Index>(r));
    if (const NonlinearForce* contact = parts_[reaction.part].effect->nonlinear_force()) {
      VectorPool::Loan nodal(scratch_, motion.displacement.size());
      nodal->setZero();
      contact->add_force(motion, own.parameters, *nodal);
      force = resultant(*nodal);
    } else {
      force = spring_reaction(reaction, own, motion);
    }
  }
}

double Model::stored_energy(const Point& at, Motion motion) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    motion.finite_share = at.parts[i].finite_share;
    sum += parts_[i].effect->energy(motion, at.parts[i].parameters);
  }
  return sum;
}

}  // namespace tissue_stiffness
