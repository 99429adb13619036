// All measured positions are too large or too small by one factor.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class ImageScale : public Effect, public SensorModel {
 public:
  const SensorModel* sensor_model() const override { return this; }
  void observe(const Parameters& p, ObservedMotion& motion) const override {
    const Eigen::Map<const Eigen::VectorXd> rest(motion.mesh.nodes.data(), motion.mesh.nodes.size());
    if (p[0] != 1.0) motion.displacement += (p[0] - 1.0) * (rest + motion.displacement);
  }
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("image_scale")) return {};
  const EffectEntry entry{"image_scale", {{"ratio", normal_prior(1.0, 0.05)}}};
  return {{entry, "ratio", entry}};
}

}  // namespace

EffectSpec image_scale_spec() {
  EffectSpec spec;
  spec.name = "image_scale";
  spec.summary = "measured positions are scaled about the origin of the model frame: a wrong pixel size or focal length";
  spec.formula = "y = s (X + u)";
  spec.source = "systematic error of a sensor's calibration";
  spec.parameters = {{"ratio", "s", "-", 0.01, 100.0, ParameterSpec::Default::required, 1.0, 1.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_image_scale(const Value&, const EffectContext&) {
  return std::make_unique<ImageScale>();
}

}  // namespace tissue_stiffness::effects
