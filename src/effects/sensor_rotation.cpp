// The axes of a sensor differ from the model's.
#include <Eigen/Geometry>

#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class SensorRotation : public Effect, public SensorModel {
 public:
  const SensorModel* sensor_model() const override { return this; }
  void observe(const Parameters& p, ObservedMotion& motion) const override {
    const Eigen::Vector3d turn = p.head<3>();
    const double angle = turn.norm();
    if (angle == 0.0) return;
    Eigen::Map<Eigen::Matrix3Xd> u(motion.displacement.data(), 3, motion.mesh.nodes.cols());
    u = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * u.eval();
  }
};

// Proposes a rotation where points are known at rest. Outlines and clouds would show the rotated body itself.
std::vector<Proposal> propose(const ProposalContext& context) {
  using Kind = ObservationSettings::Kind;
  const bool points = context.observes(Kind::vertices) || context.observes(Kind::markers) || context.observes(Kind::tracks);
  if (context.holds("sensor_rotation") || !points) return {};
  const EffectEntry entry{"sensor_rotation", {{"angles", normal_prior(Eigen::Vector3d::Zero(), 0.1)}}};
  return {{entry, "angles", entry}};
}

}  // namespace

EffectSpec sensor_rotation_spec() {
  EffectSpec spec;
  spec.name = "sensor_rotation";
  spec.summary =
      "measured displacements are turned: the sensor was matched to the body at rest, its axes are not the model's";
  spec.formula = "y = X + R(a) u";
  spec.source = "a registration's error, of a hand-eye calibration for example";
  spec.parameters = {{"angles", "a", "rad", -3.2, 3.2, ParameterSpec::Default::required, 0.0, 0.0, 3}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_sensor_rotation(const Value&, const EffectContext&) {
  return std::make_unique<SensorRotation>();
}

}  // namespace tissue_stiffness::effects
