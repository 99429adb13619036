// A clamp is compliant: springs per area replace held nodes.
#include <algorithm>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

bool is_fixed(const ModelSettings& settings, const std::string& region) {
  return std::any_of(settings.effects.begin(), settings.effects.end(), [&](const EffectSettings& effect) {
    return effect.name == "fixed" && effect.arguments.has("region") && effect.arguments.at("region").as_text() == region;
  });
}

class ElasticSupport : public Effect, public Support {
 public:
  ElasticSupport(const Value& arguments, const EffectContext& context) {
    const Value& name = arguments.at("region");
    const Region& region = find_surface(name, context.regions);
    if (!is_fixed(context.settings, name.as_text())) {
      throw InputError(name.path(), name.shown(), "the region of a `fixed` effect");
    }
    unit_ = share_matrix(facet_mass(context.mesh, region.facets));
    nodes_ = region.nodes;
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

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("elastic_support")) return {};
  const double scale = 0.05 * context.size() / context.young_modulus;
  std::vector<Proposal> list;
  for (const EffectSettings* fixed : context.all("fixed")) {
    const std::string name = fixed->arguments.at("region").as_text();
    if (context.regions.at(name).facets.empty()) continue;
    const auto with = [&name](const Quantity& compliance) {
      return EffectEntry{"elastic_support", {{"region", name}, {"compliance", compliance}}};
    };
    list.push_back({with(normal_prior(0.0, scale)), "compliance", with(log_normal_prior(scale, 4.0)), {"region"}});
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
  spec.keys = {{"region", "region of a `fixed` effect"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_elastic_support(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ElasticSupport>(arguments, context);
}

}  // namespace tissue_stiffness::effects
