// The second invariant of the strain carries a share of the shear modulus.
#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"
#include "effects/solids.hpp"
#include "fem/invariants.hpp"

namespace tissue_stiffness::effects {
namespace {

class MooneyRivlin : public PointwiseEffect {
 public:
  explicit MooneyRivlin(const EffectContext& context) : PointwiseEffect(context.fem), solids_(context, 1) {}

  bool needs_elasticity() const override { return true; }
  void add_stress(int e, int, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    solids_.at(e, [&](std::size_t s) { stress += factor(s, p) * difference(f, Derivatives::first).gradient; });
  }
  void add_tangent(int e, int, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    solids_.at(e, [&](std::size_t s) { tangent += factor(s, p) * difference(f, Derivatives::second).hessian; });
  }

 private:
  bool is_absent(const Parameters& p) const override { return p[0] == 0.0; }
  double energy_density(int e, int, const Eigen::Matrix3d& f, const Parameters& p) const override {
    double sum = 0.0;
    solids_.at(e, [&](std::size_t s) { sum += factor(s, p) * difference(f, Derivatives::first).value; });
    return sum;
  }

  double factor(std::size_t s, const Parameters& p) const { return 0.5 * p[0] * solids_.moduli(s, p).mu; }
  static Invariant difference(const Eigen::Matrix3d& f, Derivatives order) {
    Invariant out = isochoric(second_invariant(f, order), f, order);
    const Invariant first = isochoric(first_invariant(f, order), f, order);
    out.value -= first.value;
    out.gradient -= first.gradient;
    if (order == Derivatives::second) out.hessian -= first.hessian;
    return out;
  }

  Solids solids_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("mooney_rivlin") || !context.finite_strain()) return {};
  const EffectEntry entry{"mooney_rivlin", {{"share", normal_prior(0.0, 0.5)}}};
  return {{entry, "share", entry}};
}

}  // namespace

EffectSpec mooney_rivlin_spec() {
  EffectSpec spec;
  spec.name = "mooney_rivlin";
  spec.summary = "rubber-like law: a share of the shear modulus goes with the second invariant; stiffer when pressed";
  spec.formula = "psi + s mu/2 (J^-4/3 I2 - J^-2/3 I1); E and nu at small strain stay. C01/(C10 + C01) = s";
  spec.source = "Mooney 1940; Rivlin 1948; Holzapfel 2000, eq. 6.127";
  spec.parameters = {{"share", "s", "-", 0.0, 1.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.of_finite_strain = true;
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_mooney_rivlin(const Value&, const EffectContext& context) {
  return std::make_unique<MooneyRivlin>(context);
}

}  // namespace tissue_stiffness::effects
