// Damping is proportional to mass, so slow motions decay first.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class MassDamping : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.mass_damping.push_back([](const Parameters& p) { return p[0]; });
  }
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("mass_damping")) return {};
  const auto with = [](const Quantity& alpha) { return EffectEntry{"mass_damping", {{"alpha", alpha}}}; };
  return {{with(normal_prior(0.0, 3.0)), "alpha", with(log_normal_prior(3.0, 4.0))}};
}

}  // namespace

EffectSpec mass_damping_spec() {
  EffectSpec spec;
  spec.name = "mass_damping";
  spec.summary = "damping proportional to mass; damping ratio falls with frequency";
  spec.formula = "-alpha M v";
  spec.source = "Rayleigh damping, mass part";
  spec.parameters = {{"alpha", "alpha", "1/s", 0.0, 1e5, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_mass_damping(const Value&, const EffectContext&) {
  return std::make_unique<MassDamping>();
}

}  // namespace tissue_stiffness::effects
