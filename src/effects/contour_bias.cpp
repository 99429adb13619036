// Outlines and surface points are measured outside the surface, or inside it.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class ContourBias : public Effect, public SensorModel {
 public:
  const SensorModel* sensor_model() const override { return this; }
  void observe(const Parameters& p, ObservedMotion& motion) const override { motion.outward += p[0]; }
};

// Proposes a bias where points of a surface are measured without identity.
std::vector<Proposal> propose(const ProposalContext& context) {
  const bool surface =
      context.observes(ObservationSettings::Kind::contour) || context.observes(ObservationSettings::Kind::points);
  if (context.holds("contour_bias") || !surface) return {};
  const EffectEntry entry{"contour_bias", {{"bias", normal_prior(0.0, 0.005 * context.size())}}};
  return {{entry, "bias", entry}};
}

}  // namespace

EffectSpec contour_bias_spec() {
  EffectSpec spec;
  spec.name = "contour_bias";
  spec.summary = "outlines and surface points are measured outside the surface (the cavity), inside below zero";
  spec.formula = "y = x + b n";
  spec.source = "a segmentation's threshold, the thickness of a wall in ultrasound";
  spec.parameters = {{"bias", "b", "m", -1.0, 1.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_contour_bias(const Value&, const EffectContext&) {
  return std::make_unique<ContourBias>();
}

}  // namespace tissue_stiffness::effects
