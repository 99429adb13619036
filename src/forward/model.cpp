#include "tissue_stiffness/forward/model.hpp"

#include <algorithm>
#include <cmath>

#include "tissue_stiffness/meshing/build_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpeedLimit = 1e4;  // [m/s], bound of the initial velocity
const Quantity kAnySpeed{Quantity::Kind::normal, 0.0, 1.0};  // [m/s], until frames tell

const EffectSettings* find_effect(const ModelSettings& settings, const std::string& name) {
  const auto at = std::find_if(settings.effects.begin(), settings.effects.end(),
                               [&](const EffectSettings& e) { return e.name == name; });
  return at == settings.effects.end() ? nullptr : &*at;
}

const EffectSettings& require_effect(const ModelSettings& settings, const std::string& name) {
  const EffectSettings* effect = find_effect(settings, name);
  if (effect == nullptr) throw InputError(settings.name + ": effects", "no " + name, "a list that holds " + name);
  return *effect;
}

}  // namespace

double FreeParameter::to_value(double w) const {
  const double value = prior.kind == Quantity::Kind::log_normal ? std::exp(w) : w;
  return std::clamp(value, lower, upper);
}

double FreeParameter::to_coordinate(double value) const {
  return prior.kind == Quantity::Kind::log_normal ? std::log(value) : value;
}

double FreeParameter::prior_std() const {
  return prior.kind == Quantity::Kind::log_normal ? std::log(prior.spread) : prior.spread;
}

Model::Model(const ModelSettings& settings, const TetMesh& mesh)
    : settings_(settings), mesh_(mesh), fem_(mesh_), regions_(resolve_regions(settings.regions, mesh_)) {
  require_effect(settings_, "inertia");
  const EffectSettings& elasticity = require_effect(settings_, "elasticity");
  const EffectContext context{mesh_,
                              fem_,
                              regions_,
                              elasticity.arguments.at("law").as_text() != "linear",
                              read_parameters(elasticity).front().value,
                              settings_.directory,
                              courses_,
                              inputs_};
  fixed_.assign(static_cast<std::size_t>(fem_.dof_count()), 0);
  for (const EffectSettings& effect : settings_.effects) add_part(effect, context);
  add_initial_velocity();
}

void Model::add_part(const EffectSettings& settings, const EffectContext& context) {
  const std::vector<Quantity> quantities = read_parameters(settings);
  Part part;
  part.label = settings.label;
  part.offset = static_cast<int>(known_.size());
  part.count = static_cast<int>(quantities.size());
  known_.conservativeResize(part.offset + part.count);
  std::size_t k = 0;
  for (const ParameterSpec& spec : effect_spec(settings).parameters) {
    for (int c = 0; c < spec.components; ++c, ++k) {
      known_[part.offset + static_cast<int>(k)] = quantities[k].value;
      if (!quantities[k].estimated()) continue;
      const std::string suffix = spec.components > 1 ? std::string("_") + "xyz"[c] : "";
      free_.push_back({settings.label + "." + spec.name + suffix, spec.unit, quantities[k], spec.lower, spec.upper});
      free_index_.push_back(part.offset + static_cast<int>(k));
    }
  }
  part.effect = make_effect(settings, context);
  part.effect->linear_terms(part.terms);
  nonlinear_ = nonlinear_ || part.effect->nonlinear();
  for (const int node : part.effect->fixed_nodes()) std::fill_n(fixed_.begin() + 3 * node, 3, char{1});
  parts_.push_back(std::move(part));
}

void Model::add_initial_velocity() {
  const auto offset = known_.size();
  known_.conservativeResize(offset + 3);
  known_.tail<3>() = settings_.initial.velocity;
  if (settings_.initial.kind != InitialSettings::Kind::from_frames) return;
  for (int i = 0; i < 3; ++i) {
    free_.push_back({std::string("initial.velocity_") + "xyz"[i],
                     "m/s",
                     kAnySpeed,
                     -kSpeedLimit,
                     kSpeedLimit});
    free_index_.push_back(static_cast<int>(offset) + i);
  }
}

void Model::set_velocity_prior(const Eigen::Vector3d& mean, double std) {
  for (std::size_t i = 0; i < 3; ++i) {
    free_[free_.size() - 3 + i].prior = {Quantity::Kind::normal, mean[static_cast<Eigen::Index>(i)], std};
  }
}

void Model::forget_velocity_prior() {
  if (settings_.initial.kind != InitialSettings::Kind::from_frames) return;
  for (std::size_t i = 0; i < 3; ++i) free_[free_.size() - 3 + i].prior = kAnySpeed;
}

Eigen::VectorXd Model::theta(const Eigen::VectorXd& w) const {
  Eigen::VectorXd result = known_;
  for (std::size_t i = 0; i < free_.size(); ++i) {
    result[free_index_[i]] = free_[i].to_value(w[static_cast<Eigen::Index>(i)]);
  }
  return result;
}

Eigen::VectorXd Model::prior_mean() const {
  Eigen::VectorXd w(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) w[static_cast<Eigen::Index>(i)] = free_[i].prior_mean();
  return w;
}

Eigen::VectorXd Model::prior_std() const {
  Eigen::VectorXd s(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) s[static_cast<Eigen::Index>(i)] = free_[i].prior_std();
  return s;
}

SparseMatrix Model::mass(const Eigen::VectorXd& theta) const {
  SparseMatrix m = fem_.pattern();
  for (const Part& part : parts_) {
    for (const MatrixTerm& term : part.terms.mass) m += term.coefficient(part.parameters(theta)) * term.matrix;
  }
  return m;
}

SparseMatrix Model::stiffness(const Eigen::VectorXd& theta) const {
  SparseMatrix k = fem_.pattern();
  for (const Part& part : parts_) {
    if (part.effect->stiffness_is_reference()) continue;
    for (const MatrixTerm& term : part.terms.stiffness) k += term.coefficient(part.parameters(theta)) * term.matrix;
  }
  return k;
}

SparseMatrix Model::reference_stiffness(const Eigen::VectorXd& theta) const {
  SparseMatrix k = fem_.pattern();
  for (const Part& part : parts_) {
    for (const MatrixTerm& term : part.terms.stiffness) k += term.coefficient(part.parameters(theta)) * term.matrix;
  }
  return k;
}

Eigen::VectorXd Model::stiffness_coefficients(const Eigen::VectorXd& theta) const {
  std::vector<double> values;
  for (const Part& part : parts_) {
    for (const MatrixTerm& term : part.terms.stiffness) values.push_back(term.coefficient(part.parameters(theta)));
  }
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

double Model::mass_damping(const Eigen::VectorXd& theta) const {
  double sum = 0.0;
  for (const Part& part : parts_) {
    for (const Coefficient& c : part.terms.mass_damping) sum += c(part.parameters(theta));
  }
  return sum;
}

double Model::stiffness_damping(const Eigen::VectorXd& theta) const {
  double sum = 0.0;
  for (const Part& part : parts_) {
    for (const Coefficient& c : part.terms.stiffness_damping) sum += c(part.parameters(theta));
  }
  return sum;
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

void Model::add_loads(const Eigen::VectorXd& theta, double time, Eigen::VectorXd& force) const {
  for (const Part& part : parts_) {
    for (const LoadTerm& term : part.terms.loads) {
      const double course = term.course ? term.course->value(time, term.component) : 1.0;
      force += term.coefficient(part.parameters(theta)) * course * term.pattern;
    }
  }
}

void Model::add_nonlinear_force(const Eigen::VectorXd& theta, const Motion& motion, Eigen::VectorXd& force) const {
  for (const Part& part : parts_) part.effect->add_force(motion, part.parameters(theta), force);
}

void Model::add_nonlinear_stiffness(const Eigen::VectorXd& theta, const Motion& motion, SparseMatrix& stiffness) const {
  for (const Part& part : parts_) part.effect->add_stiffness(motion, part.parameters(theta), stiffness);
}

double Model::stored_energy(const Eigen::VectorXd& theta, const Motion& motion) const {
  double sum = 0.0;
  for (const Part& part : parts_) sum += part.effect->energy(motion, part.parameters(theta));
  return sum;
}

}  // namespace tissue_stiffness
