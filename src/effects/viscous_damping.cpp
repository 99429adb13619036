// Kelvin-Voigt damping: fast motions die first.
#include "tissue_stiffness/effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class ViscousDamping : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    out.stiffness_damping.push_back([](const Parameters& p) { return p[0]; });
  }
};

}  // namespace

EffectSpec viscous_damping_spec() {
  EffectSpec spec;
  spec.name = "viscous_damping";
  spec.summary = "damping proportional to the elastic stiffness at rest; damping ratio rises with frequency";
  spec.formula = "-beta K v";
  spec.source = "Kelvin-Voigt solid; Rayleigh damping, stiffness part";
  spec.parameters = {{"beta", "beta", "s", 0.0, 1e2, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  return spec;
}

std::unique_ptr<Effect> make_viscous_damping(const Value&, const EffectContext&) {
  return std::make_unique<ViscousDamping>();
}

}  // namespace tissue_stiffness::effects
