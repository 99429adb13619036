// The tissue becomes stiffer with strain.
#include <Eigen/Cholesky>
#include <functional>

#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"
#include "effects/solids.hpp"
#include "fem/invariants.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kMostExponent = 50.0;  // of the exponential: beyond it a step has diverged

// Factor of the elastic stress, and its derivative with respect to the energy density psi [1/Pa].
struct StressScale {
  double value, slope;
};

// Returns exp(b Q) - 1 with Q = 2 psi / E.
StressScale excess(double b, double modulus, double psi) {
  const double exponent = 2.0 * b * psi / modulus;
  if (!(exponent < kMostExponent)) throw NumericalError("strain_stiffening: strain beyond every bound");
  return {std::expm1(exponent), 2.0 * b / modulus * std::exp(exponent)};
}

class StrainStiffening : public PointwiseEffect, public NonlinearForce {
 public:
  explicit StrainStiffening(const EffectContext& context)
      : PointwiseEffect(context.fem), fem_(context.fem), solids_(context, 1) {}

  bool needs_elasticity() const override { return true; }
  const NonlinearForce* nonlinear_force() const override { return this; }

  // This and add_stiffness are the small-strain form.
  void add_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    if (p[0] == 0.0 || motion.finite_share == 1.0) return;
    const auto stress = [&](int e, int q) -> Strain {
      const Point x = evaluate(motion.displacement, e, q, p);
      return (1.0 - motion.finite_share) * x.excess.value * x.stress;
    };
    add_stress_force(fem_, std::cref(stress), force);
  }
  void add_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    if (p[0] == 0.0 || motion.finite_share == 1.0) return;
    const StrainFactorField factor = [&](int e, int q) -> StrainFactor {
      const Point x = evaluate(motion.displacement, e, q, p);
      if (!(x.excess.value > 0.0)) return StrainFactor(6, 0);
      const StrainFactor elastic = isotropic_factor(x.moduli.lambda, x.moduli.mu);
      const Eigen::Matrix<double, 6, 6> d =
          x.excess.value * elastic * elastic.transpose() + x.excess.slope * x.stress * x.stress.transpose();
      return StrainFactor(Eigen::Matrix<double, 6, 6>(d.llt().matrixL()));
    };
    add_strain_stiffness(fem_, factor, 1.0 - motion.finite_share, stiffness);
  }

  void add_stress(int e, int, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    solids_.at(e, [&](std::size_t s) {
      const Lame c = solids_.moduli(s, p);
      stress += excess(p[0], solids_.modulus(s, p), neo_hookean_energy(c, f)).value * neo_hookean_stress(c, f);
    });
  }
  void add_tangent(int e, int, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    solids_.at(e, [&](std::size_t s) {
      const Lame c = solids_.moduli(s, p);
      const StressScale scale = excess(p[0], solids_.modulus(s, p), neo_hookean_energy(c, f));
      const Eigen::Matrix3d elastic = neo_hookean_stress(c, f);
      tangent += scale.value * neo_hookean_tangent(c, f) + scale.slope * outer(elastic, elastic);
    });
  }

 private:
  bool is_absent(const Parameters& p) const override { return p[0] == 0.0; }
  // The integral of exp(b Q) - 1 over psi.
  double energy_density(int e, int, const Eigen::Matrix3d& f, const Parameters& p) const override {
    double sum = 0.0;
    solids_.at(e, [&](std::size_t s) {
      const double psi = neo_hookean_energy(solids_.moduli(s, p), f);
      sum += excess(p[0], solids_.modulus(s, p), psi).value / (2.0 * p[0] / solids_.modulus(s, p)) - psi;
    });
    return sum;
  }

  struct Point {
    Lame moduli;  ///< of the elasticity there
    Strain stress;
    StressScale excess;
  };
  Point evaluate(const Eigen::VectorXd& u, int e, int q, const Parameters& p) const {
    Point x{{0.0, 0.0}, Strain::Zero(), {0.0, 0.0}};
    solids_.at(e, [&](std::size_t s) {
      x.moduli = solids_.moduli(s, p);
      const Strain strain = strain_at(fem_, u, e, q);
      x.stress = 2.0 * x.moduli.mu * strain;
      x.stress.head<3>().array() += x.moduli.lambda * strain.head<3>().sum();
      x.excess = excess(p[0], solids_.modulus(s, p), 0.5 * strain.dot(x.stress));
    });
    return x;
  }
  const Discretisation& fem_;
  Solids solids_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("strain_stiffening")) return {};
  const auto with = [](const Quantity& exponent) { return EffectEntry{"strain_stiffening", {{"exponent", exponent}}}; };
  return {{with(normal_prior(0.0, 10.0)), "exponent", with(log_normal_prior(10.0, 4.0))}};
}

}  // namespace

EffectSpec strain_stiffening_spec() {
  EffectSpec spec;
  spec.name = "strain_stiffening";
  spec.summary = "elastic stress grows exponentially with the stored energy";
  spec.formula =
      "sigma exp(b Q), Q = 2 psi / E (the square of the strain in uniaxial stretch); psi the elasticity's energy";
  spec.source = "Fung 1967; Demiray 1972";
  spec.parameters = {{"exponent", "b", "-", 0.0, 1e6, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_strain_stiffening(const Value&, const EffectContext& context) {
  return std::make_unique<StrainStiffening>(context);
}

}  // namespace tissue_stiffness::effects
