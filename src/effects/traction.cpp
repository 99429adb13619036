// A measured force, with or without its torque, is spread over a patch of the surface, or acts at points.
#include "effects/force_shares.hpp"
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class Traction : public Effect {
 public:
  Traction(const Value& arguments, const EffectContext& context)
      : patterns_(wrench_patterns(arguments, context)), course_(load_course(arguments, LoadInput::Kind::wrench, context)) {}

  void linear_terms(LinearTerms& out) const override {
    for (std::size_t i = 0; i < patterns_.size(); ++i) {
      LoadTerm load;
      load.pattern = patterns_[i];
      load.coefficient = [](const Parameters& p) { return p[0]; };
      load.course = course_;
      load.component = static_cast<int>(i);
      out.loads.push_back(std::move(load));
    }
  }

 private:
  std::vector<Eigen::VectorXd> patterns_;  ///< of each component of the wrench
  std::shared_ptr<Course> course_;
};

}  // namespace

EffectSpec traction_spec() {
  EffectSpec spec;
  spec.name = "traction";
  spec.summary =
      "measured total force on a patch of the surface or at points, spread evenly, or so that it has the measured torque";
  spec.formula =
      "scale w_a (F(t) + theta(t) x r_a), w_a = int N_a dA / A; theta = 0, or the sum over the patch has the torque T(t) "
      "about the sensor";
  spec.source = "Yang & Lin 2016, eq. 4, fourth term";
  spec.parameters = {{"scale", "s", "-", -1e3, 1e3, ParameterSpec::Default::optional, 1.0, 0.0, 1}};
  spec.keys = {{"region", "facets it acts on; where it holds none, its vertices in equal parts"},
               {"topic", "geometry_msgs/WrenchStamped"},
               {"course", "{file: f.csv} with rows of time [s], fx, fy, fz [N], tx, ty, tz [N m]; instead of topic"},
               {"torque_about",
                "[x, y, z], where the torque is measured, with the body at rest [m]: the origin of the sensor's frame; "
                "the torque does not act when absent"}};
  spec.load = LoadInput::Kind::wrench;
  for (auto& key : load_error_keys("N", true)) spec.keys.push_back(std::move(key));
  for (auto& key : torque_error_keys()) spec.keys.push_back(std::move(key));
  return spec;
}

std::unique_ptr<Effect> make_traction(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Traction>(arguments, context);
}

}  // namespace tissue_stiffness::effects
