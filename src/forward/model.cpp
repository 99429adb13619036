#include "forward/model.hpp"

#include <algorithm>
#include <cmath>

#include "effects/registry.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSpeedLimit = 1e4;                          // [m/s], bound of the initial velocity
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
    : Model(settings, mesh, resolve_regions(settings.regions, mesh)) {}

Model::Model(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions)
    : Model(settings, std::make_shared<const Body>(mesh, std::move(regions)), nullptr) {}

Model::Model(const ModelSettings& settings, const Model& relative) : Model(settings, relative.body_, &relative) {}

Model::Model(const ModelSettings& settings, std::shared_ptr<const Body> body, const Model* relative)
    : settings_(settings), body_(std::move(body)), rest_(Eigen::VectorXd::Zero(fem().dof_count())) {
  require_effect(settings_, "inertia");
  const EffectContext shared = context();
  constraint_count_.assign(static_cast<std::size_t>(fem().node_count()), 0);
  for (const EffectSettings& effect : settings_.effects) add_part(effect, shared, relative);
  link_elasticities();
  for (Part& part : parts_) {
    part.effect->linear_terms(part.terms);
    settle_terms(part);
    finite_law_ = finite_law_ || part.effect->always_finite();
    nonlinear_ = nonlinear_ || part.effect->nonlinear() || !part.terms.finite_share.empty();
  }
  nonlinear_ = nonlinear_ || finite_law_;
  check_laws();
  fixed_.assign(static_cast<std::size_t>(fem().dof_count()), 0);
  for (std::size_t node = 0; node < constraint_count_.size(); ++node) {
    if (constraint_count_[node] > 0) std::fill_n(fixed_.begin() + static_cast<std::ptrdiff_t>(3 * node), 3, char{1});
  }
  add_initial_velocity();
}

EffectContext Model::context() {
  const EffectSettings& elasticity = require_effect(settings_, "elasticity");
  std::vector<std::vector<int>> solids;
  for (const EffectSettings& effect : settings_.effects) {
    if (effect.name != "elasticity") continue;
    solids.push_back(solid_elements(effect.arguments, fem().element_count(), regions()));
  }
  const double modulus = read_parameters(elasticity).front().value;
  return {mesh(), fem(), regions(), settings_, std::move(solids), modulus, courses_, inputs_};
}

void Model::add_part(const EffectSettings& settings, const EffectContext& context, const Model* relative) {
  Part part;
  part.label = settings.label;
  add_parameters(settings, part);
  if (relative != nullptr) part.effect = relative->shared_effect(settings);
  if (!part.effect) part.effect = make_effect(settings, context);
  for (const int node : part.effect->fixed_nodes()) ++constraint_count_[static_cast<std::size_t>(node)];
  parts_.push_back(std::move(part));
}

// Returns null where there is none.
std::shared_ptr<const Effect> Model::shared_effect(const EffectSettings& settings) const {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const EffectSettings& own = settings_.effects[i];
    if (!parts_[i].effect->shareable() || own.name != settings.name || !own.arguments.same(settings.arguments)) continue;
    return parts_[i].effect;
  }
  return nullptr;
}

void Model::add_parameters(const EffectSettings& settings, Part& part) {
  const std::vector<Quantity> quantities = read_parameters(settings);
  auto quantity = quantities.begin();
  for (const ParameterSpec& spec : effect_spec(settings).parameters) {
    for (int c = 0; c < spec.components; ++c, ++quantity) {
      const auto index = static_cast<int>(known_.size());
      known_.conservativeResize(index + 1);
      known_[index] = quantity->value;
      part.indices.push_back(index);
      const std::string suffix = spec.components > 1 ? std::string("_") + "xyz"[c] : "";
      const std::string name = settings.label + "." + spec.name + suffix;
      if (!quantity->estimated()) {
        if (quantity->tolerance > 0.0 && !settings_.exact_inputs)
          constants_.push_back({name, index, quantity->value, quantity->tolerance});
        continue;
      }
      free_.push_back({name, spec.unit, *quantity, spec.lower, spec.upper});
      free_index_.push_back(index);
    }
  }
}

// Effects that alter the elastic law read its parameters after their own.
void Model::link_elasticities() {
  std::vector<int> elastic;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    if (settings_.effects[i].name != "elasticity") continue;
    elastic.insert(elastic.end(), parts_[i].indices.begin(), parts_[i].indices.end());
  }
  for (Part& part : parts_) {
    if (part.effect->needs_elasticity()) part.indices.insert(part.indices.end(), elastic.begin(), elastic.end());
  }
}

// Finite strain applies to the whole model, because a mixture of laws would have no meaning for the effects between them.
void Model::check_laws() const {
  bool linear = false, blended = false;
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    linear = linear || (settings_.effects[i].name == "elasticity" && !parts_[i].effect->always_finite());
    blended = blended || !parts_[i].terms.finite_share.empty();
  }
  if (finite_law_ && (linear || blended)) {
    throw InputError(settings_.name + ": effects",
                     linear ? "elasticities of small and of finite strain" : "finite strain twice",
                     "one law for all; geometric_nonlinearity only with law: linear");
  }
}

// Patterns whose parameters are all known are computed once.
void Model::settle_terms(Part& part) const {
  const Eigen::VectorXd p = part.parameters(known_);
  for (LoadTerm& load : part.terms.loads) {
    if (!load.shaped) continue;
    load.pattern = load.shaped(p);
    if (!estimated(part, load.shape)) load.shaped = nullptr;
  }
}

bool Model::estimated(const Part& part, const std::vector<int>& shape) const {
  return std::any_of(shape.begin(), shape.end(), [&](int i) {
    const int index = part.indices[static_cast<std::size_t>(i)];
    return std::find(free_index_.begin(), free_index_.end(), index) != free_index_.end();
  });
}

bool Model::estimated(const Part& part) const {
  return std::any_of(free_.begin(), free_.end(),
                     [&](const FreeParameter& p) { return p.name.rfind(part.label + ".", 0) == 0; });
}

void Model::add_initial_velocity() {
  const auto offset = known_.size();
  known_.conservativeResize(offset + 3);
  known_.tail<3>() = settings_.initial.velocity;
  if (settings_.initial.kind != InitialSettings::Kind::from_frames) return;
  for (int i = 0; i < 3; ++i) {
    free_.push_back({std::string("initial.velocity_") + "xyz"[i], "m/s", kAnySpeed, -kSpeedLimit, kSpeedLimit});
    free_index_.push_back(static_cast<int>(offset) + i);
  }
}

void Model::set_velocity_prior(const Eigen::Vector3d& mean, double std) {
  for (std::size_t i = 0; i < 3; ++i) {
    free_[free_.size() - 3 + i].prior = {Quantity::Kind::normal, mean[static_cast<Eigen::Index>(i)], std};
  }
}

void Model::know(const Eigen::VectorXd& theta) {
  known_ = theta;
  free_.clear();
  free_index_.clear();
  for (Part& part : parts_) settle_terms(part);
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

Eigen::VectorXd Model::drift() const {
  Eigen::VectorXd d(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) d[static_cast<Eigen::Index>(i)] = free_[i].prior.drift;
  return d;
}

void Model::set_first_stamp(double time) {
  first_stamp_ = time;
  for (auto& course : courses_) course.second->shift(time);
}

void Model::drive(double first_stamp, const std::vector<LoadSample>& loads) {
  set_first_stamp(first_stamp);
  for (const LoadSample& sample : loads) {
    const auto course = courses_.find(sample.topic);
    if (course != courses_.end()) course->second->add(sample.time, sample.value);
  }
}

std::map<std::string, double> Model::values(const Eigen::VectorXd& w) const {
  std::map<std::string, double> out;
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const FreeParameter& free = free_[static_cast<std::size_t>(i)];
    out[free.name] = free.to_value(w[i]);
  }
  return out;
}

Eigen::VectorXd Model::coordinates(const std::map<std::string, double>& values, Eigen::VectorXd w) const {
  for (Eigen::Index i = 0; i < w.size(); ++i) {
    const FreeParameter& free = free_[static_cast<std::size_t>(i)];
    const auto value = values.find(free.name);
    if (value != values.end()) w[i] = free.to_coordinate(value->second);
  }
  return w;
}

}  // namespace tissue_stiffness
