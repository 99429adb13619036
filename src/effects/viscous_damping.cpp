// Kelvin-Voigt damping acts, so fast motions decay first.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class ViscousDamping : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.stiffness_damping.push_back([](const Parameters& p) { return p[0]; });
  }
};

// The prior corresponds to a damping ratio of a few per cent at ten hertz.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("viscous_damping")) return {};
  const auto with = [](const Quantity& beta) { return EffectEntry{"viscous_damping", {{"beta", beta}}}; };
  return {{with(normal_prior(0.0, 2e-3)), "beta", with(log_normal_prior(2e-3, 4.0))}};
}

}  // namespace

EffectSpec viscous_damping_spec() {
  EffectSpec spec;
  spec.name = "viscous_damping";
  spec.summary = "damping proportional to the elastic stiffness at rest; damping ratio rises with frequency";
  spec.formula = "-beta K v; under finite strain the stress beta C : E' of Green's strain rate";
  spec.source = "Kelvin-Voigt solid; Rayleigh damping, stiffness part; Holzapfel 2000, sec. 6.9";
  spec.parameters = {{"beta", "beta", "s", 0.0, 1e2, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_viscous_damping(const Value&, const EffectContext&) {
  return std::make_unique<ViscousDamping>();
}

}  // namespace tissue_stiffness::effects
