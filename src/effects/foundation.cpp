// Elastic surroundings hold a surface.
#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kLeastCosine = 0.01;  // between a normal and a direction that its facet faces; that of flat sides is 0

// Returns every facet outside the regions of `fixed`.
std::vector<int> loose_surface(const TetMesh& mesh, const ModelSettings& settings,
                               const std::map<std::string, Region>& regions) {
  std::vector<char> held(static_cast<std::size_t>(mesh.facet_count()), 0);
  for (const EffectSettings& effect : settings.effects) {
    if (effect.name != "fixed" || !effect.arguments.has("region")) continue;
    for (const int f : find_region(effect.arguments.at("region"), regions).facets) held[static_cast<std::size_t>(f)] = 1;
  }
  std::vector<int> loose;
  for (int f = 0; f < mesh.facet_count(); ++f) {
    if (held[static_cast<std::size_t>(f)] == 0) loose.push_back(f);
  }
  return loose;
}

// Returns the facets whose normal points in this direction and that lie on this side of the middle of the body's bounding
// box.
std::vector<int> facing(const TetMesh& mesh, const std::vector<int>& facets, const Eigen::Vector3d& direction) {
  const Eigen::Vector3d middle = 0.5 * (mesh.nodes.rowwise().minCoeff() + mesh.nodes.rowwise().maxCoeff());
  const FacetQuadrature quadrature(mesh.quadratic() ? 6 : 3);
  std::vector<int> out;
  for (const int f : facets) {
    const FacetNodes x = facet_nodes(mesh, f);
    const Eigen::Vector3d centre = x.leftCols<3>().rowwise().mean();
    const double cosine = quadrature.normal(x, 0).normalized().dot(direction);
    if (cosine > kLeastCosine && (centre - middle).dot(direction) > 0.0) out.push_back(f);
  }
  return out;
}

std::vector<int> held_facets(const Value& arguments, const EffectContext& context) {
  const std::vector<int> all = arguments.has("region") ? find_surface(arguments.at("region"), context.regions).facets
                                                       : loose_surface(context.mesh, context.settings, context.regions);
  if (!arguments.has("facing")) return all;
  const Value& key = arguments.at("facing");
  const Eigen::Vector3d direction = key.as_vector3("");
  const std::vector<int> out = facing(context.mesh, all, direction.normalized());
  if (out.empty()) throw InputError(key.path(), key.shown(), "a direction that a part of the surface faces");
  return out;
}

class Foundation : public Effect {
 public:
  Foundation(const Value& arguments, const EffectContext& context)
      : unit_(share_matrix(facet_mass(context.mesh, held_facets(arguments, context)))) {}

  void linear_terms(LinearTerms& out) const override {
    out.stiffness.push_back({unit_, [](const Parameters& p) { return p[0]; }});
  }

 private:
  std::shared_ptr<const SparseMatrix> unit_;
};

// Proposes a foundation on the whole loose surface, on each side of it, and on every named surface that is not held.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("foundation")) return {};
  const double scale = 0.1 * context.young_modulus / context.size();
  std::vector<Proposal> list;
  const auto add = [&](const std::vector<std::pair<std::string, Argument>>& where) {
    const auto with = [&where](const Quantity& stiffness) {
      EffectEntry entry{"foundation", where};
      entry.arguments.emplace_back("stiffness", stiffness);
      return entry;
    };
    list.push_back({with(normal_prior(0.0, scale)), "stiffness", with(log_normal_prior(scale, 4.0)), {"region", "facing"}});
  };
  add({});
  const std::vector<int> loose = loose_surface(context.mesh, context.settings, context.regions);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Eigen::Vector3d direction = Eigen::Vector3d::Zero();
      direction[axis] = sign;
      if (!facing(context.mesh, loose, direction).empty()) add({{"facing", direction}});
    }
  }
  for (const auto& [name, region] : context.regions) {
    if (region.facets.empty() || context.names("fixed", name)) continue;
    add({{"region", name}});
  }
  return list;
}

}  // namespace

EffectSpec foundation_spec() {
  EffectSpec spec;
  spec.name = "foundation";
  spec.summary = "soft surroundings that hold a surface: springs in every direction, a stiffness per rest area";
  spec.formula = "-k int N_a N_b dA u_b";
  spec.source = "Winkler foundation";
  spec.parameters = {{"stiffness", "k", "N/m^3", 0.0, 1e15, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.keys = {{"region", "facets that are held; without it the whole surface outside the regions of `fixed`"},
               {"facing", "[x, y, z]: only the half of the surface that faces this direction"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_foundation(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Foundation>(arguments, context);
}

}  // namespace tissue_stiffness::effects
