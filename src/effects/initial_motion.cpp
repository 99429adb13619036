// The body already moves when the recording begins.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

enum Index { kEquilibrium, kDisplacement = 1, kVelocity = 4, kSecondDisplacement = 7, kSecondVelocity = 10 };

class InitialMotionEffect : public Effect {
 public:
  bool shareable() const override { return true; }
  void linear_terms(LinearTerms& terms) const override {
    terms.initial_motion = [](const Parameters& p) {
      InitialMotion out;
      out.equilibrium = p[kEquilibrium];
      out.displacement << p.segment<3>(kDisplacement), p.segment<3>(kSecondDisplacement);
      out.velocity << p.segment<3>(kVelocity), p.segment<3>(kSecondVelocity);
      return out;
    };
  }
};

}  // namespace

EffectSpec initial_motion_spec() {
  const auto optional = ParameterSpec::Default::optional;
  EffectSpec spec;
  spec.name = "initial_motion";
  spec.summary = "the body is loaded, and moves, when the recording begins";
  spec.formula =
      "u(t0) = c K^-1 f(t0) + sum_i d_i a_i + e_i b_i, u'(t0) = c K^-1 f'(t0) + sum_i v_i a_i + w_i b_i; a_i ~ K^-1 M 1_i, "
      "b_i ~ K^-1 M a_i, both of largest displacement 1";
  spec.source = "load-dependent Ritz vectors: Wilson, Yuan & Dickens, Earthq. Eng. Struct. Dyn. 10 (1982)";
  spec.parameters = {{"equilibrium", "c", "-", -10.0, 10.0, optional, 1.0, 0.0},
                     {"displacement", "d", "m", -10.0, 10.0, optional, 0.0, 0.0, 3},
                     {"velocity", "v", "m/s", -1e4, 1e4, optional, 0.0, 0.0, 3},
                     {"second_displacement", "e", "m", -10.0, 10.0, optional, 0.0, 0.0, 3},
                     {"second_velocity", "w", "m/s", -1e4, 1e4, optional, 0.0, 0.0, 3}};
  spec.of_recording = true;
  return spec;
}

std::unique_ptr<Effect> make_initial_motion(const Value&, const EffectContext&) {
  return std::make_unique<InitialMotionEffect>();
}

}  // namespace tissue_stiffness::effects
