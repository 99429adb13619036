// Part of the stiffness relaxes (standard linear solid).
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class Viscoelasticity : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.relaxation.push_back({[](const Parameters& p) { return p[0]; }, [](const Parameters& p) { return p[1]; }});
  }
};

// Proposes seven time constants from the frame interval to the recording's duration, at equal ratios.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("viscoelasticity")) return {};
  constexpr int count = 7;
  const auto with = [](const Quantity& gamma, const Argument& tau) {
    return EffectEntry{"viscoelasticity", {{"gamma", gamma}, {"tau", tau}}};
  };
  std::vector<Proposal> list;
  for (int i = 0; i < count; ++i) {
    const double tau = context.frame_interval * std::pow(context.duration / context.frame_interval, i / (count - 1.0));
    list.push_back(
        {with(normal_prior(0.0, 0.3), tau), "gamma", with(log_normal_prior(0.3, 3.0), log_normal_prior(tau, 3.0))});
  }
  return list;
}

}  // namespace

EffectSpec viscoelasticity_spec() {
  EffectSpec spec;
  spec.name = "viscoelasticity";
  spec.summary = "a branch of the whole stiffness at rest that relaxes: stiffer when fast, soft when slow, lossy between";
  spec.formula = "-gamma K (u - z), tau z' = u - z; under finite strain Green's strain takes the place of u";
  spec.source = "standard linear solid, Simo & Hughes 1998, sec. 10.2";
  spec.parameters = {{"gamma", "gamma", "-", 0.0, 1e3, ParameterSpec::Default::required, 0.0, 0.0, 1},
                     {"tau", "tau", "s", 1e-6, 1e6, ParameterSpec::Default::required, 0.0, NAN, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_viscoelasticity(const Value&, const EffectContext&) {
  return std::make_unique<Viscoelasticity>();
}

}  // namespace tissue_stiffness::effects
