// The shear stress grows with another power of the stretch.
#include <cmath>

#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"
#include "effects/solids.hpp"
#include "fem/invariants.hpp"
#include "fem/principal_stretches.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kNoExponent = 1e-4;  // smaller exponents count as this one: the law has a limit at zero

// Powers of the isochoric stretches, less one, and what is left of them without their mean.
struct Powers {
  Powers(const PrincipalStretches& at, double exponent)
      : alpha(std::copysign(std::max(std::abs(exponent), kNoExponent), exponent)) {
    const Eigen::Vector3d logs = at.stretches.array().log();
    const double mean = logs.mean();
    for (int a = 0; a < 3; ++a) less_one[a] = std::expm1(alpha * (logs[a] - mean));
    deviator = less_one.array() - less_one.mean();
  }
  double alpha;
  Eigen::Vector3d less_one, deviator;
};

class Ogden : public PointwiseEffect {
 public:
  explicit Ogden(const EffectContext& context) : PointwiseEffect(context.fem), solids_(context, 1) {}

  bool needs_elasticity() const override { return true; }
  void add_stress(int e, int, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    solids_.at(e, [&](std::size_t s) {
      const PrincipalStretches at = principal_stretches(f);
      const double mu = solids_.moduli(s, p).mu;
      stress += principal_stress(at, slopes(at, mu, Powers(at, p[0]))) - neo_hookean(f, mu, Derivatives::first).gradient;
    });
  }
  void add_tangent(int e, int, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    solids_.at(e, [&](std::size_t s) {
      const PrincipalStretches at = principal_stretches(f);
      const double mu = solids_.moduli(s, p).mu;
      const Powers powers(at, p[0]);
      tangent += principal_tangent(at, slopes(at, mu, powers), curvatures(at, mu, powers)) -
                 neo_hookean(f, mu, Derivatives::second).hessian;
    });
  }

 private:
  bool is_absent(const Parameters& p) const override { return p[0] == 2.0; }
  double energy_density(int e, int, const Eigen::Matrix3d& f, const Parameters& p) const override {
    double sum = 0.0;
    solids_.at(e, [&](std::size_t s) {
      const double mu = solids_.moduli(s, p).mu;
      const Powers powers(principal_stretches(f), p[0]);
      sum += 2.0 * mu / (powers.alpha * powers.alpha) * powers.less_one.sum();
      sum -= neo_hookean(f, mu, Derivatives::first).value - 1.5 * mu;
    });
    return sum;
  }

  // Returns d psi / d lambda_a.
  static Eigen::Vector3d slopes(const PrincipalStretches& at, double mu, const Powers& powers) {
    return 2.0 * mu / powers.alpha * powers.deviator.cwiseQuotient(at.stretches);
  }
  // Returns d^2 psi / d lambda_a d lambda_b.
  static Eigen::Matrix3d curvatures(const PrincipalStretches& at, double mu, const Powers& powers) {
    Eigen::Matrix3d out;
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        const double same = a == b ? 1.0 : 0.0, power = 1.0 + powers.less_one[a];
        out(a, b) = 2.0 * mu / (at.stretches[a] * at.stretches[b]) *
                    (power * (same - 1.0 / 3.0) - powers.deviator[b] / 3.0 - same * powers.deviator[a] / powers.alpha);
      }
    }
    return out;
  }
  // Returns mu/2 J^-2/3 I1, which this law replaces.
  static Invariant neo_hookean(const Eigen::Matrix3d& f, double mu, Derivatives order) {
    Invariant out = isochoric(first_invariant(f, order), f, order);
    out.value *= 0.5 * mu;
    out.gradient *= 0.5 * mu;
    if (order == Derivatives::second) out.hessian *= 0.5 * mu;
    return out;
  }

  Solids solids_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("ogden") || !context.finite_strain()) return {};
  const EffectEntry entry{"ogden", {{"exponent", normal_prior(2.0, 10.0)}}};
  return {{entry, "exponent", entry}};
}

}  // namespace

EffectSpec ogden_spec() {
  EffectSpec spec;
  spec.name = "ogden";
  spec.summary = "the shear stress grows with another power of the stretch than two; stiffer when pressed below zero";
  spec.formula =
      "psi + 2 mu/alpha^2 (sum of J^-alpha/3 lambda_a^alpha - 3) - mu/2 (J^-2/3 I1 - 3); E and nu at small strain stay";
  spec.source = "Ogden 1972; Holzapfel 2000, eq. 6.119, one term";
  spec.parameters = {{"exponent", "alpha", "-", -50.0, 50.0, ParameterSpec::Default::required, 0.0, 2.0, 1}};
  spec.of_finite_strain = true;
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_ogden(const Value&, const EffectContext& context) {
  return std::make_unique<Ogden>(context);
}

}  // namespace tissue_stiffness::effects
