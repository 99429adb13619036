// A measured total force is spread evenly over a patch of the surface, or acts at points.
#include "effects/force_shares.hpp"
#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

class Traction : public Effect {
 public:
  Traction(const Value& arguments, const EffectContext& context)
      : course_(load_course(arguments, LoadInput::Kind::wrench, context)) {
    weights_ = force_shares(arguments.at("region"), context);
  }

  void linear_terms(LinearTerms& out) const override {
    for (int i = 0; i < 3; ++i) {
      LoadTerm load;
      load.pattern = along_axis(weights_, i);
      load.coefficient = [](const Parameters& p) { return p[0]; };
      load.course = course_;
      load.component = i;
      out.loads.push_back(std::move(load));
    }
  }

 private:
  Eigen::VectorXd weights_;
  std::shared_ptr<Course> course_;
};

}  // namespace

EffectSpec traction_spec() {
  EffectSpec spec;
  spec.name = "traction";
  spec.summary =
      "measured total force, spread evenly over a patch of the surface or acting at points; the torque is not used";
  spec.formula = "scale F(t) int N_a dA / A";
  spec.source = "Yang & Lin 2016, eq. 4, fourth term";
  spec.parameters = {{"scale", "s", "-", -1e3, 1e3, ParameterSpec::Default::optional, 1.0, 0.0, 1}};
  spec.keys = {{"region", "facets it acts on; where it holds none, its vertices in equal parts"},
               {"topic", "geometry_msgs/WrenchStamped"},
               {"course", "{file: f.csv} with rows of time [s], fx, fy, fz [N], tx, ty, tz [N m]; instead of topic"}};
  spec.load = LoadInput::Kind::wrench;
  for (auto& key : load_error_keys("N", true)) spec.keys.push_back(std::move(key));
  return spec;
}

std::unique_ptr<Effect> make_traction(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Traction>(arguments, context);
}

}  // namespace tissue_stiffness::effects
