// Finite strain replaces small strain.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class GeometricNonlinearity : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.finite_share.push_back([](const Parameters& p) { return p[0]; });
  }
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("geometric_nonlinearity") || context.finite_strain()) return {};
  const auto with = [](const Argument& share) { return EffectEntry{"geometric_nonlinearity", {{"share", share}}}; };
  return {{with(normal_prior(0.0, 0.5)), "share", with(1.0)}};
}

}  // namespace

EffectSpec geometric_nonlinearity_spec() {
  EffectSpec spec;
  spec.name = "geometric_nonlinearity";
  spec.summary = "finite strain in place of small strain: every law and load of `law: linear` in its finite form";
  spec.formula = "(1 - s) f_small + s f_finite; elasticity is neo-Hookean, pressure follows the surface";
  spec.source = "Bonet & Wood 2008, ch. 6";
  spec.parameters = {{"share", "s", "-", 0.0, 1.0, ParameterSpec::Default::optional, 1.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_geometric_nonlinearity(const Value&, const EffectContext&) {
  return std::make_unique<GeometricNonlinearity>();
}

}  // namespace tissue_stiffness::effects
