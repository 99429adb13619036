// The recording is itself a simulation, whose finite time step makes fast oscillations slower.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class PeriodElongation : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.stiffness_inertia.push_back([](const Parameters& p) { return p[0] / 6.0; });
  }
};

// Simulators take one to several steps a frame. Every simulation has such an error, usually a small one.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("period_elongation") || context.holds("moved")) return {};  // springs of `moved` have no inertia
  const double step = 0.25 * context.frame_interval, longest = 0.5 * context.frame_interval;
  const auto with = [](const Quantity& square) { return EffectEntry{"period_elongation", {{"step_squared", square}}}; };
  return {{with(normal_prior(0.0, longest * longest)), "step_squared", with(log_normal_prior(step * step, 4.0))}};
}

}  // namespace

// Average acceleration gives a mode of frequency w the frequency w' with tan(w' h / 2) = w h / 2 and does not change
// statics. M + h^2 / 6 K has w'^2 = w^2 / (1 + (w h)^2 / 6). The two differ by (w h)^4 / 480.
EffectSpec period_elongation_spec() {
  EffectSpec spec;
  spec.name = "period_elongation";
  spec.summary = "the recording is a simulation whose time step h elongates periods (Newmark, average acceleration)";
  spec.formula = "-h^2 / 6 K a";
  spec.source = "Hughes 1987, sec. 9.1; Bathe 1996, sec. 9.4";
  spec.parameters = {{"step_squared", "h^2", "s^2", 0.0, 1e2, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  spec.of_simulation = true;
  return spec;
}

std::unique_ptr<Effect> make_period_elongation(const Value&, const EffectContext&) {
  return std::make_unique<PeriodElongation>();
}

}  // namespace tissue_stiffness::effects
