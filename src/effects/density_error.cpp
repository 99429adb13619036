// Every mass differs from that of the model file.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class DensityError : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.mass_factor.push_back([](const Parameters& p) { return 1.0 + p[0]; });
  }
};

// Proposes nothing where a density is estimated already.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("density_error") || context.estimates("inertia", "density")) return {};
  const EffectEntry entry{"density_error", {{"relative", normal_prior(0.0, 0.1)}}};
  return {{entry, "relative", entry}};
}

}  // namespace

EffectSpec density_error_spec() {
  EffectSpec spec;
  spec.name = "density_error";
  spec.summary = "every mass of the model is off by the same share";
  spec.formula = "(1 + r) M";
  spec.source = "systematic error of the density; equivalent to a change of E where gravity or inertia are the only forces";
  spec.parameters = {{"relative", "r", "-", -0.99, 100.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_density_error(const Value&, const EffectContext&) {
  return std::make_unique<DensityError>();
}

}  // namespace tissue_stiffness::effects
