// A pressure transducer has a wrong zero: a constant pressure acts in addition to the measured one.
#include "effects/pressed_surface.hpp"
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kScale = 5e-3;  // of Young's modulus: strains of a few per cent in a wall that is a tenth of its radius

class PressureOffset : public Effect, public FiniteStrainForm, public FollowerLoad {
 public:
  PressureOffset(const Value& arguments, const EffectContext& context) : surface_(arguments.at("region"), context) {}

  bool shareable() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    LoadTerm load;
    load.pattern = surface_.unit_force();
    load.coefficient = [](const Parameters& p) { return p[0]; };
    out.loads.push_back(std::move(load));
  }
  const FiniteStrainForm* finite_strain() const override { return this; }

  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    surface_.add_force(&motion.displacement, p[0], force);
  }
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    surface_.add_stiffness(motion.displacement, p[0], stiffness);
  }
  const FollowerLoad* follower_load() const override { return this; }
  double size(double, double, const Parameters& p) const override { return p[0]; }
  void add_unit_force(const Eigen::VectorXd& u, Eigen::VectorXd& force) const override {
    surface_.add_force(&u, 1.0, force);
  }

 private:
  PressedSurface surface_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  std::vector<Proposal> list;
  for (const std::string& region : context.regions_of("pressure", "pressure_offset")) {
    const EffectEntry entry{"pressure_offset",
                            {{"region", region}, {"pressure", normal_prior(0.0, kScale * context.young_modulus)}}};
    list.push_back({entry, "pressure", entry, {"region"}});
  }
  return list;
}

}  // namespace

EffectSpec pressure_offset_spec() {
  EffectSpec spec;
  spec.name = "pressure_offset";
  spec.summary = "a constant pressure on a surface: the zero of a pressure transducer";
  spec.formula = "-p_0 int N_a n dA";
  spec.source = "systematic error of a load's sensor: its zero; follower load: Bonet & Wood 2008, sec. 8.5.2";
  spec.parameters = {{"pressure", "p_0", "Pa", -1e6, 1e6, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.keys = {{"region", "facets it pushes on"}};
  spec.proposals = propose;
  spec.of_recording = true;
  return spec;
}

std::unique_ptr<Effect> make_pressure_offset(const Value& arguments, const EffectContext& context) {
  return std::make_unique<PressureOffset>(arguments, context);
}

}  // namespace tissue_stiffness::effects
