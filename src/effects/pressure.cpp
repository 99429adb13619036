// A fluid presses on a surface, as a dead load for small strain and a follower load for finite strain.
#include "effects/pressed_surface.hpp"
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class Pressure : public Effect, public FiniteStrainForm, public FollowerLoad {
 public:
  Pressure(const Value& arguments, const EffectContext& context)
      : surface_(arguments.at("region"), context), course_(load_course(arguments, LoadInput::Kind::pressure, context)) {}

  void linear_terms(LinearTerms& out) const override {
    LoadTerm load;
    load.pattern = surface_.unit_force();
    load.coefficient = [](const Parameters& p) { return p[0]; };
    load.course = course_;
    out.loads.push_back(std::move(load));
  }
  const FiniteStrainForm* finite_strain() const override { return this; }

  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    surface_.add_force(&motion.displacement, size(motion.time, motion.load_factor, p), force);
  }
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    surface_.add_stiffness(motion.displacement, size(motion.time, motion.load_factor, p), stiffness);
  }
  const FollowerLoad* follower_load() const override { return this; }
  double size(double time, double load_factor, const Parameters& p) const override {
    return load_factor * p[0] * course_->value(time, 0);
  }
  void add_unit_force(const Eigen::VectorXd& u, Eigen::VectorXd& force) const override {
    surface_.add_force(&u, 1.0, force);
  }

 private:
  PressedSurface surface_;
  std::shared_ptr<Course> course_;
};

}  // namespace

EffectSpec pressure_spec() {
  EffectSpec spec;
  spec.name = "pressure";
  spec.summary = "measured pressure of a fluid on a surface; follows the surface when the strain is finite";
  spec.formula = "-scale p(t) int N_a n dA";
  spec.source = "Yang & Lin 2016, eq. 4, fourth term; follower load: Bonet & Wood 2008, sec. 8.5.2";
  spec.parameters = {{"scale", "s", "-", -1e3, 1e3, ParameterSpec::Default::optional, 1.0, 0.0, 1}};
  spec.keys = {{"region", "facets it pushes on"},
               {"topic", "sensor_msgs/FluidPressure, positive pushes on the tissue"},
               {"course", "{file: p.csv} with rows of time [s], pressure [Pa]; instead of topic"}};
  spec.load = LoadInput::Kind::pressure;
  for (auto& key : load_error_keys("Pa", false)) spec.keys.push_back(std::move(key));
  return spec;
}

std::unique_ptr<Effect> make_pressure(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Pressure>(arguments, context);
}

}  // namespace tissue_stiffness::effects
