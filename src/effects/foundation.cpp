// Elastic surroundings that hold a surface.
#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

// Every facet outside the regions of `fixed`.
std::vector<int> loose_surface(const EffectContext& context) {
  std::vector<char> held(static_cast<std::size_t>(context.mesh.facet_count()), 0);
  for (const EffectSettings& effect : context.settings.effects) {
    if (effect.name != "fixed" || !effect.arguments.has("region")) continue;
    for (const int f : context.region(effect.arguments.at("region")).facets) held[static_cast<std::size_t>(f)] = 1;
  }
  std::vector<int> loose;
  for (int f = 0; f < context.mesh.facet_count(); ++f) {
    if (held[static_cast<std::size_t>(f)] == 0) loose.push_back(f);
  }
  return loose;
}

class Foundation : public Effect {
 public:
  Foundation(const Value& arguments, const EffectContext& context)
      : unit_(shared(facet_mass(context.mesh, arguments.has("region")
                                                  ? find_surface(arguments.at("region"), context.regions).facets
                                                  : loose_surface(context)))) {}

  void linear_terms(LinearTerms& out) const override {
    out.stiffness.push_back({unit_, [](const Parameters& p) { return p[0]; }});
  }

 private:
  std::shared_ptr<const SparseMatrix> unit_;
};

// On the whole loose surface and on every named one that nothing holds.
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
    list.push_back({with(normal(0.0, scale)), "stiffness", with(log_normal(scale, 4.0)), "region"});
  };
  add({});
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
  spec.keys = {{"region", "facets that are held; without it the whole surface outside the regions of `fixed`"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_foundation(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Foundation>(arguments, context);
}

}  // namespace tissue_stiffness::effects
