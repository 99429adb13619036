// Elastic surroundings hold a surface.
#include <algorithm>
#include <iterator>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kLeastCosine = 0.01;  // between a normal and a direction that its facet faces; that of flat sides is 0
constexpr double kFlat = 0.02;         // of the body's size, and of a normal: what counts as the same plane

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

// Returns the facets in the plane of a clamp's facets, which a clamp that is drawn too small leaves out. There are none
// where the clamp is not flat.
std::vector<int> level_with(const TetMesh& mesh, const std::vector<int>& facets, const std::vector<int>& clamp) {
  const FacetQuadrature quadrature(mesh.quadratic() ? 6 : 3);
  const double size = body_size(mesh.nodes);
  const auto normal = [&](int f) { return Eigen::Vector3d(quadrature.normal(facet_nodes(mesh, f), 0)); };
  Eigen::Vector3d whole = Eigen::Vector3d::Zero();
  for (const int f : clamp) whole += normal(f);
  const Eigen::Vector3d direction = whole.normalized(), point = mesh.nodes.col(mesh.facets(0, clamp.front()));
  const auto level = [&](int f) {
    const Eigen::VectorXd heights = (facet_nodes(mesh, f).colwise() - point).transpose() * direction;
    return normal(f).normalized().dot(direction) > 1.0 - kFlat && heights.cwiseAbs().maxCoeff() < kFlat * size;
  };
  std::vector<int> out;
  if (!std::all_of(clamp.begin(), clamp.end(), level)) return out;
  std::copy_if(facets.begin(), facets.end(), std::back_inserter(out), level);
  return out;
}

std::vector<int> held_facets(const Value& arguments, const EffectContext& context) {
  const std::vector<int> all = arguments.has("region") ? find_surface(arguments.at("region"), context.regions).facets
                                                       : loose_surface(context.mesh, context.settings, context.regions);
  if (arguments.has("level_with")) {
    const Value& clamp = arguments.at("level_with");
    const std::vector<int> out = level_with(context.mesh, all, find_surface(clamp, context.regions).facets);
    if (out.empty()) throw InputError(clamp.path(), clamp.shown(), "a flat region in whose plane other facets lie");
    return out;
  }
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

// Proposes a foundation on the whole loose surface, on each side of it, and on every named surface that is not held. What
// lies beside a clamp in its plane is proposed as stiff: the clamp may be drawn too small.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("foundation")) return {};
  const double soft = 0.1 * context.young_modulus / context.size(), stiff = 100.0 * soft;
  std::vector<Proposal> list;
  const auto add = [&](const std::vector<std::pair<std::string, Argument>>& where, double likely) {
    const auto with = [&where](const Quantity& stiffness) {
      EffectEntry entry{"foundation", where};
      entry.arguments.emplace_back("stiffness", stiffness);
      return entry;
    };
    list.push_back({with(normal_prior(0.0, soft)),
                    "stiffness",
                    with(log_normal_prior(likely, 4.0)),
                    {"region", "facing", "level_with"}});
  };
  add({}, soft);
  const std::vector<int> loose = loose_surface(context.mesh, context.settings, context.regions);
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      Eigen::Vector3d direction = Eigen::Vector3d::Zero();
      direction[axis] = sign;
      if (!facing(context.mesh, loose, direction).empty()) add({{"facing", direction}}, soft);
    }
  }
  for (const auto& [name, region] : context.regions) {
    if (region.facets.empty()) continue;
    if (!context.names("fixed", name)) {
      add({{"region", name}}, soft);
    } else if (!level_with(context.mesh, loose, region.facets).empty()) {
      add({{"level_with", name}}, stiff);
    }
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
               {"facing", "[x, y, z]: only the half of the surface that faces this direction; without it the whole"},
               {"level_with", "a flat region: only the facets beside it in its plane; without it the whole"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_foundation(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Foundation>(arguments, context);
}

}  // namespace tissue_stiffness::effects
