// A clamp is compliant: springs per area replace held nodes, all or those near its edge.
#include <algorithm>
#include <cmath>
#include <limits>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kShares[] = {0.35, 0.65, 0.9};  // of a clamp's depth, which may be drawn too large
constexpr double kSpread = 4.0;                  // factor of a compliance's prior

bool is_fixed(const ModelSettings& settings, const std::string& region) {
  return std::any_of(settings.effects.begin(), settings.effects.end(), [&](const EffectSettings& effect) {
    return effect.name == "fixed" && effect.arguments.has("region") && effect.arguments.at("region").as_text() == region;
  });
}

// How deep the clamp holds the body: the distance of each of its nodes from the nearest node outside [m].
std::vector<double> depths(const TetMesh& mesh, const Region& region) {
  std::vector<char> held(static_cast<std::size_t>(mesh.node_count()), 0);
  for (const int node : region.nodes) held[static_cast<std::size_t>(node)] = 1;
  std::vector<double> out;
  for (const int node : region.nodes) {
    double least = std::numeric_limits<double>::infinity();
    for (int other = 0; other < mesh.node_count(); ++other) {
      if (held[static_cast<std::size_t>(other)] != 0) continue;
      least = std::min(least, (mesh.nodes.col(other) - mesh.nodes.col(node)).squaredNorm());
    }
    out.push_back(std::sqrt(least));
  }
  return out;
}

// Returns the nodes of a clamp that are no deeper than `within`.
std::vector<int> nodes_near_edge(const Value& within, const TetMesh& mesh, const Region& region) {
  const std::vector<double> depth = depths(mesh, region);
  const double most = within.as_number(0.0, std::numeric_limits<double>::max(), "m");
  std::vector<int> out;
  for (std::size_t i = 0; i < depth.size(); ++i) {
    if (depth[i] <= most) out.push_back(region.nodes[i]);
  }
  if (!out.empty()) return out;
  throw InputError(within.path(), within.shown(),
                   "at least " + std::to_string(*std::min_element(depth.begin(), depth.end())) +
                       " m, where the region's first nodes are");
}

// Returns the region's facets that have any of these nodes.
std::vector<int> facets_with(const std::vector<int>& nodes, const TetMesh& mesh, const Region& region) {
  std::vector<int> out;
  for (const int f : region.facets) {
    const int* own = mesh.facets.col(f).data();
    const auto yields = [&nodes](int node) { return std::binary_search(nodes.begin(), nodes.end(), node); };
    if (std::any_of(own, own + mesh.facets.rows(), yields)) out.push_back(f);
  }
  return out;
}

class ElasticSupport : public Effect, public Support {
 public:
  ElasticSupport(const Value& arguments, const EffectContext& context) {
    const Value& name = arguments.at("region");
    const Region& region = find_surface(name, context.regions);
    if (!is_fixed(context.settings, name.as_text())) {
      throw InputError(name.path(), name.shown(), "the region of a `fixed` effect");
    }
    nodes_ = arguments.has("within") ? nodes_near_edge(arguments.at("within"), context.mesh, region) : region.nodes;
    unit_ = share_matrix(facet_mass(context.mesh, facets_with(nodes_, context.mesh, region)));
  }

  void linear_terms(LinearTerms& out) const override {
    out.stiffness.push_back({unit_, [](const Parameters& p) { return p[0] > 0.0 ? 1.0 / p[0] : 0.0; }});
  }
  const Support* support() const override { return this; }
  std::vector<int> compliant_nodes() const override { return nodes_; }
  bool is_compliant(const Parameters& p) const override { return p[0] > 0.0; }

 private:
  std::shared_ptr<const SparseMatrix> unit_;
  std::vector<int> nodes_;
};

// Proposes that the whole clamp yields, or that it holds the body less deep than it is drawn.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("elastic_support")) return {};
  const double scale = 0.05 * context.size() / context.young_modulus;
  std::vector<Proposal> list;
  for (const EffectSettings* fixed : context.all("fixed")) {
    const std::string name = fixed->arguments.at("region").as_text();
    const Region& region = context.regions.at(name);
    if (region.facets.empty()) continue;
    const auto add = [&](const std::vector<std::pair<std::string, Argument>>& where) {
      const auto with = [&where](const Quantity& compliance) {
        EffectEntry entry{"elastic_support", where};
        entry.arguments.emplace_back("compliance", compliance);
        return entry;
      };
      list.push_back(
          {with(normal_prior(0.0, scale)), "compliance", with(log_normal_prior(scale, kSpread)), {"region", "within"}});
    };
    add({{"region", name}});
    std::vector<double> depth = depths(context.mesh, region);
    std::sort(depth.begin(), depth.end());
    for (const double share : kShares) {
      const double within = share * depth.back();
      if (depth.front() <= within) add({{"region", name}, {"within", within}});
    }
  }
  return list;
}

}  // namespace

EffectSpec elastic_support_spec() {
  EffectSpec spec;
  spec.name = "elastic_support";
  spec.summary = "a compliant clamp: the region of a `fixed` effect rests on springs; rigid at compliance 0";
  spec.formula = "-1/c int N_a N_b dA u_b on the region, instead of u = 0";
  spec.source = "Robin condition; an elastic layer of thickness h and modulus E has c = h / E";
  spec.parameters = {{"compliance", "c", "m^3/N", 0.0, 1.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.keys = {{"region", "region of a `fixed` effect"},
               {"within", "m: only the region's nodes this near to the rest of the body yield; without it all do"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_elastic_support(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ElasticSupport>(arguments, context);
}

}  // namespace tissue_stiffness::effects
