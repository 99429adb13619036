// The axes of a force sensor differ from the model's.
#include <Eigen/Geometry>
#include <algorithm>

#include "effects/force_shares.hpp"
#include "effects/registry.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

Eigen::Matrix3d rotation(const Parameters& angles) {
  const Eigen::Vector3d turn = angles.head<3>();
  const double angle = turn.norm();
  if (angle == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

// Returns what the traction on this region reads.
const Value& traction_on(const Value& region, const EffectContext& context) {
  for (const EffectSettings& effect : context.settings.effects) {
    if (effect.name == "traction" && effect.arguments.at("region").as_text() == region.as_text()) return effect.arguments;
  }
  throw InputError(region.path(), region.shown(), "the region of a `traction` effect");
}

class LoadRotation : public Effect {
 public:
  LoadRotation(const Value& traction, const EffectContext& context)
      : patterns_(wrench_patterns(traction, context)), course_(load_course(traction, LoadInput::Kind::wrench, context)) {}

  // Adds the difference between the rotated force and torque and the measured ones.
  void linear_terms(LinearTerms& out) const override {
    for (std::size_t first = 0; first < patterns_.size(); first += 3) {
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          LoadTerm load;
          load.pattern = patterns_[first + static_cast<std::size_t>(i)];
          load.coefficient = [i, j](const Parameters& p) { return rotation(p)(i, j) - (i == j ? 1.0 : 0.0); };
          load.course = course_;
          load.component = static_cast<int>(first) + j;
          out.loads.push_back(std::move(load));
        }
      }
    }
  }

 private:
  std::vector<Eigen::VectorXd> patterns_;  ///< of each component of the wrench
  std::shared_ptr<Course> course_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  std::vector<Proposal> list;
  for (const std::string& name : context.regions_of("traction", "load_rotation")) {
    const EffectEntry entry{"load_rotation", {{"region", name}, {"angles", normal_prior(Eigen::Vector3d::Zero(), 0.1)}}};
    list.push_back({entry, "angles", entry, {"region"}});
  }
  return list;
}

}  // namespace

EffectSpec load_rotation_spec() {
  EffectSpec spec;
  spec.name = "load_rotation";
  spec.summary =
      "the measured force of a `traction`, and its torque, are turned: the axes of the sensor are not the model's";
  spec.formula = "a traction by (R(a) - I) F(t), and (R(a) - I) T(t)";
  spec.source = "an error of the sensor's mounting or of a transform";
  spec.parameters = {{"angles", "a", "rad", -3.2, 3.2, ParameterSpec::Default::required, 0.0, 0.0, 3}};
  spec.keys = {{"region", "region of a `traction` effect"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_load_rotation(const Value& arguments, const EffectContext& context) {
  return std::make_unique<LoadRotation>(traction_on(arguments.at("region"), context), context);
}

}  // namespace tissue_stiffness::effects
