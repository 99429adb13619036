// All measured loads are wrong by the same factor, as from a sensor that is out of calibration.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class ForceScale : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.load_factor.push_back([](const Parameters& p) { return 1.0 + p[0]; });
  }
};

// Proposes a scale where a load is measured and no scale is estimated.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("force_scale") || !(context.holds("pressure") || context.holds("traction"))) return {};
  if (context.estimates("pressure", "scale") || context.estimates("traction", "scale")) return {};
  const EffectEntry entry{"force_scale", {{"relative", normal_prior(0.0, 0.1)}}};
  return {{entry, "relative", entry}};
}

}  // namespace

EffectSpec force_scale_spec() {
  EffectSpec spec;
  spec.name = "force_scale";
  spec.summary = "every measured load (pressure, traction) is off by the same share";
  spec.formula = "(1 + r) f(t)";
  spec.source = "systematic error of a load's sensor; equivalent to a change of E where no other force acts";
  spec.parameters = {{"relative", "r", "-", -10.0, 100.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_force_scale(const Value&, const EffectContext&) {
  return std::make_unique<ForceScale>();
}

}  // namespace tissue_stiffness::effects
