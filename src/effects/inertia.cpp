// The body's inertia is the force -M a with M_ab = rho int N_a N_b dV.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class Inertia : public Effect {
 public:
  Inertia(const Value&, const EffectContext& context)
      : unit_mass_(share_matrix(context.fem.mass(Eigen::VectorXd::Ones(context.fem.element_count())))) {}

  bool shareable() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    out.mass.push_back({unit_mass_, [](const Parameters& p) { return p[0]; }});
  }

 private:
  std::shared_ptr<const SparseMatrix> unit_mass_;
};

}  // namespace

EffectSpec inertia_spec() {
  EffectSpec spec;
  spec.name = "inertia";
  spec.summary = "mass of the body (consistent mass matrix)";
  spec.formula = "-rho int N_a N_b dV a_b";
  spec.source = "Yang & Lin 2016, eq. 4, first term";
  spec.parameters = {{"density", "rho", "kg/m^3", 1.0, 2e4, ParameterSpec::Default::required, 0.0, NAN, 1, 0.0, 0.04}};
  return spec;
}

std::unique_ptr<Effect> make_inertia(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Inertia>(arguments, context);
}

}  // namespace tissue_stiffness::effects
