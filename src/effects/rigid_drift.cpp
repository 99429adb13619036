// The sensor, or the base of the body, moves slowly.
#include <Eigen/Geometry>

#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class RigidDrift : public Effect, public SensorModel {
 public:
  const SensorModel* sensor_model() const override { return this; }
  void observe(const Parameters& p, ObservedMotion& motion) const override {
    const Eigen::Vector3d shift = motion.time * p.head<3>(), turn = motion.time * p.tail<3>();
    const double angle = turn.norm();
    if (angle == 0.0 && shift.isZero(0.0)) return;
    Eigen::Matrix3d more = Eigen::Matrix3d::Zero();  // R - I
    if (angle > 0.0) more = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() - Eigen::Matrix3d::Identity();
    Eigen::Map<Eigen::Matrix3Xd> u(motion.displacement.data(), 3, motion.mesh.nodes.cols());
    for (Eigen::Index node = 0; node < u.cols(); ++node) {
      u.col(node) += more * (motion.mesh.nodes.col(node) + u.col(node)).eval() + shift;
    }
  }
};

// Proposes a translation and a rotation; a refit may do both.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("rigid_drift")) return {};
  const double speed = 0.01 * context.size() / context.duration, rate = 0.01 / context.duration;
  const EffectEntry both{"rigid_drift",
                         {{"velocity", normal_prior(Eigen::Vector3d::Zero(), speed)},
                          {"rotation", normal_prior(Eigen::Vector3d::Zero(), rate)}}};
  return {{both.without("rotation"), "velocity", both}, {both.without("velocity"), "rotation", both}};
}

}  // namespace

EffectSpec rigid_drift_spec() {
  EffectSpec spec;
  spec.name = "rigid_drift";
  spec.summary = "measured positions move on and turn about the origin of the model frame, steadily from the start";
  spec.formula = "y = R(w t) (X + u) + v t";
  spec.source = "a sensor that is not held fast";
  spec.parameters = {{"velocity", "v", "m/s", -10.0, 10.0, ParameterSpec::Default::optional, 0.0, 0.0, 3},
                     {"rotation", "w", "rad/s", -10.0, 10.0, ParameterSpec::Default::optional, 0.0, 0.0, 3}};
  spec.proposals = propose;
  spec.of_recording = true;
  return spec;
}

std::unique_ptr<Effect> make_rigid_drift(const Value&, const EffectContext&) {
  return std::make_unique<RigidDrift>();
}

}  // namespace tissue_stiffness::effects
