// Measurements are stamped late or early relative to the loads.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class TimeOffset : public Effect, public SensorModel {
 public:
  const SensorModel* sensor_model() const override { return this; }
  double delay(const Parameters& p) const override { return p[0]; }
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("time_offset")) return {};
  const EffectEntry entry{"time_offset", {{"offset", normal_prior(0.0, context.frame_interval)}}};
  return {{entry, "offset", entry}};
}

}  // namespace

EffectSpec time_offset_spec() {
  EffectSpec spec;
  spec.name = "time_offset";
  spec.summary = "measurements are stamped late (early below zero) against the loads and the start";
  spec.formula = "y(t) = X + u(t - dt)";
  spec.source = "latency of a sensor, two clocks";
  spec.parameters = {{"offset", "dt", "s", -10.0, 10.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_time_offset(const Value&, const EffectContext&) {
  return std::make_unique<TimeOffset>();
}

}  // namespace tissue_stiffness::effects
