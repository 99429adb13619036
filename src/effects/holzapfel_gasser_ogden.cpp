// Collagen fibres that scatter about a direction, stiffen exponentially and carry no pressure.
#include <cmath>

#include "effects/fibre_field.hpp"
#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"
#include "fem/invariants.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

enum Index { kStiffness, kExponent, kDispersion, kAngle, kTilt };
constexpr double kMostExponent = 50.0;  // of the exponential: beyond it a step has diverged

class HolzapfelGasserOgden : public PointwiseEffect {
 public:
  HolzapfelGasserOgden(const Value& arguments, const EffectContext& context)
      : PointwiseEffect(context.fem), fibres_(arguments, context) {}

  void add_stress(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    const Invariant strain = mean_strain(e, q, f, p, Derivatives::first);
    if (strain.value > 0.0) stress += p[kStiffness] * strain.value * growth(strain.value, p) * strain.gradient;
  }
  void add_tangent(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    const Invariant strain = mean_strain(e, q, f, p, Derivatives::second);
    if (!(strain.value > 0.0)) return;
    const double c = p[kStiffness] * growth(strain.value, p), x = strain.value;
    tangent += c * (1.0 + 2.0 * p[kExponent] * x * x) * outer(strain.gradient, strain.gradient) + c * x * strain.hessian;
  }

 private:
  bool is_absent(const Parameters& p) const override { return p[kStiffness] == 0.0; }
  double energy_density(int e, int q, const Eigen::Matrix3d& f, const Parameters& p) const override {
    const double strain = mean_strain(e, q, f, p, Derivatives::first).value;
    if (!(strain > 0.0)) return 0.0;
    const double square = strain * strain, k2 = p[kExponent];
    return 0.5 * p[kStiffness] * (k2 > 0.0 ? std::expm1(k2 * square) / k2 : square);
  }

  // Returns kappa (I1 - 3) + (1 - 3 kappa) (I4 - 1) of the isochoric deformation.
  Invariant mean_strain(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, Derivatives order) const {
    const double kappa = p[kDispersion];
    Invariant out = isochoric(first_invariant(f, order), f, order);
    const Invariant along = isochoric(fibre_invariant(f, fibres_.direction(e, q, p[kAngle], p[kTilt]), order), f, order);
    out.value = kappa * (out.value - 3.0) + (1.0 - 3.0 * kappa) * (along.value - 1.0);
    out.gradient = kappa * out.gradient + (1.0 - 3.0 * kappa) * along.gradient;
    if (order == Derivatives::second) out.hessian = kappa * out.hessian + (1.0 - 3.0 * kappa) * along.hessian;
    return out;
  }
  static double growth(double strain, const Parameters& p) {
    const double exponent = p[kExponent] * strain * strain;
    if (!(exponent < kMostExponent)) throw NumericalError("holzapfel_gasser_ogden: strain beyond every bound");
    return std::exp(exponent);
  }

  FibreField fibres_;
};

// Fibres that stiffen slowly show where they lie; a fit turns them and finds how fast they stiffen.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("holzapfel_gasser_ogden") || !context.finite_strain()) return {};
  const double scale = 0.5 * context.young_modulus;
  std::vector<Proposal> list;
  for (const FibreField::Trial& trial : FibreField::trials(context.mesh)) {
    const auto with = [&trial](const Argument& angle, const Argument& tilt, const Quantity& stiffness,
                               const Argument& exponent) {
      EffectEntry entry = FibreField::entry("holzapfel_gasser_ogden", trial, angle, tilt);
      entry.arguments.emplace_back("stiffness", stiffness);
      entry.arguments.emplace_back("exponent", exponent);
      return entry;
    };
    Proposal proposal{with(trial.angle, 0.0, normal_prior(0.0, scale), 1.0), "stiffness",
                      with(normal_prior(trial.angle, FibreField::kTurn), normal_prior(0.0, FibreField::kTurn),
                           log_normal_prior(scale, 3.0), log_normal_prior(2.0, 4.0))};
    if (!trial.straight) proposal.kind_keys = {"direction"};
    list.push_back(std::move(proposal));
  }
  return list;
}

}  // namespace

EffectSpec holzapfel_gasser_ogden_spec() {
  EffectSpec spec;
  spec.name = "holzapfel_gasser_ogden";
  spec.summary =
      "one family of collagen fibres: scattered, exponentially stiffening, slack when pressed; two entries for two";
  spec.formula = "k1/(2 k2) (exp(k2 x^2) - 1) where x > 0, x = kappa (J^-2/3 I1 - 3) + (1 - 3 kappa) (J^-2/3 |F a|^2 - 1)";
  spec.source = "Gasser, Ogden & Holzapfel 2006, eq. 4.1";
  spec.parameters = {{"stiffness", "k1", "Pa", 0.0, 1e12, ParameterSpec::Default::required, 0.0, 0.0, 1},
                     {"exponent", "k2", "-", 0.0, 1e6, ParameterSpec::Default::required, 0.0, NAN, 1},
                     {"dispersion", "kappa", "-", 0.0, 1.0 / 3.0, ParameterSpec::Default::optional, 0.0, NAN, 1}};
  for (const ParameterSpec& angle : FibreField::angles()) spec.parameters.push_back(angle);
  spec.keys = FibreField::keys();
  spec.of_finite_strain = true;
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_holzapfel_gasser_ogden(const Value& arguments, const EffectContext& context) {
  return std::make_unique<HolzapfelGasserOgden>(arguments, context);
}

}  // namespace tissue_stiffness::effects
