#include "forward/model.hpp"

#include <algorithm>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

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

bool requires_finite_strain(const ModelPart& part) {
  const FiniteStrainForm* finite = part.effect->finite_strain();
  return finite != nullptr && finite->always_finite();
}

}  // namespace

Model::Model(const ModelSettings& settings, const TetMesh& mesh)
    : Model(settings, mesh, resolve_regions(settings, mesh)) {}

Model::Model(const ModelSettings& settings, const TetMesh& mesh, std::map<std::string, Region> regions)
    : Model(settings, std::make_shared<const Body>(mesh, std::move(regions)), nullptr) {}

Model::Model(const ModelSettings& settings, const Model& relative) : Model(settings, relative.body_, &relative) {}

Model::Model(const ModelSettings& settings, std::shared_ptr<const Body> body, const Model* relative)
    : settings_(settings), body_(std::move(body)) {
  require_effect(settings_, "inertia");
  const EffectContext shared = context();
  constraint_count_.assign(static_cast<std::size_t>(fem().node_count()), 0);
  for (const EffectSettings& effect : settings_.effects) add_part(effect, shared, relative);
  link_elasticities();
  for (Part& part : parts_) {
    part.effect->linear_terms(part.terms);
    settle_terms(part);
    finite_law_ = finite_law_ || requires_finite_strain(part);
    nonlinear_ = nonlinear_ || part.effect->nonlinear_force() != nullptr || !part.terms.finite_share.empty();
  }
  nonlinear_ = nonlinear_ || finite_law_;
  check_laws();
  fixed_.assign(static_cast<std::size_t>(fem().dof_count()), 0);
  for (std::size_t node = 0; node < constraint_count_.size(); ++node) {
    if (constraint_count_[node] > 0) std::fill_n(fixed_.begin() + static_cast<std::ptrdiff_t>(3 * node), 3, char{1});
  }
  parameters_.add_initial_velocity(settings_.initial);
  prior_theta_ = parameters_.known();
  sensors_ = Sensors(mesh(), parts_);
  loads_.set_rest(settings_.time.start);
  find_reacting_regions();
  rest_ = Eigen::VectorXd::Zero(fem().dof_count() + 3 * static_cast<Eigen::Index>(reactions_.size()));
}

void Model::find_reacting_regions() {
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const LinearTerms& terms = parts_[i].terms;
    Eigen::MatrixX3d springs = Eigen::MatrixX3d::Zero(fem().dof_count(), 3);
    const NonlinearForce* force = parts_[i].effect->nonlinear_force();
    if (force != nullptr && !force->reacting_region().empty()) {
      reactions_.push_back({i, force->reacting_region(), springs});
    }
    if (terms.guided_region.empty()) continue;
    for (const MatrixTerm& term : terms.stiffness) {
      for (int axis = 0; axis < 3; ++axis)
        springs.col(axis) += *term.matrix * along_axis(Eigen::VectorXd::Ones(fem().node_count()), axis);
    }
    reactions_.push_back({i, terms.guided_region, std::move(springs)});
  }
}

EffectContext Model::context() {
  const EffectSettings& elasticity = require_effect(settings_, "elasticity");
  std::vector<std::vector<int>> solids;
  for (const EffectSettings& effect : settings_.effects) {
    if (effect.name != "elasticity") continue;
    solids.push_back(solid_elements(effect.arguments, fem().element_count(), body_->regions));
  }
  const double modulus = read_parameters(elasticity).front().value;
  return {mesh(), fem(), body_->regions, settings_, std::move(solids), modulus, loads_.courses(), loads_.inputs()};
}

void Model::add_part(const EffectSettings& settings, const EffectContext& context, const Model* relative) {
  Part part;
  part.label = settings.label;
  part.indices = parameters_.add(settings, settings_.exact_inputs);
  if (relative != nullptr) part.effect = relative->shared_effect(settings);
  if (!part.effect) part.effect = make_effect(settings, context);
  if (const Support* support = part.effect->support()) {
    for (const int node : support->fixed_nodes()) ++constraint_count_[static_cast<std::size_t>(node)];
  }
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
    linear = linear || (settings_.effects[i].name == "elasticity" && !requires_finite_strain(parts_[i]));
    blended = blended || !parts_[i].terms.finite_share.empty();
  }
  if (finite_law_ && (linear || blended)) {
    throw InputError(settings_.name + ": effects",
                     linear ? "elasticities of small and of finite strain" : "finite strain twice",
                     "one law for all; geometric_nonlinearity only with law: linear");
  }
  if (may_be_finite()) return;
  for (const EffectSettings& effect : settings_.effects) {
    if (!effect_spec(effect).of_finite_strain) continue;
    throw InputError(settings_.name + ": effects", effect.name + " at small strain",
                     "it beside elasticity with law: neo_hookean, or beside geometric_nonlinearity");
  }
}

// Patterns whose parameters are all known are computed once.
void Model::settle_terms(Part& part) const {
  const Eigen::VectorXd p = part.parameters(parameters_.known());
  for (LoadTerm& load : part.terms.loads) {
    if (!load.shaped) continue;
    load.pattern = load.shaped(p);
    if (!estimated(part, load.shape)) load.shaped = nullptr;
  }
}

bool Model::estimated(const Part& part, const std::vector<int>& shape) const {
  return std::any_of(shape.begin(), shape.end(),
                     [&](int i) { return parameters_.is_free(part.indices[static_cast<std::size_t>(i)]); });
}

bool Model::estimated(const Part& part) const {
  const std::vector<FreeParameter>& free = parameters_.free();
  return std::any_of(free.begin(), free.end(),
                     [&](const FreeParameter& p) { return p.name.rfind(part.label + ".", 0) == 0; });
}

void Model::know(const Eigen::VectorXd& theta) {
  parameters_.know(theta);
  for (Part& part : parts_) settle_terms(part);
}

}  // namespace tissue_stiffness
