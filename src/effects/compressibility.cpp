// Poisson's ratio differs from that of the model file.
#include <algorithm>

#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"
#include "effects/solids.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kLowest = -0.9, kHighest = 0.4999;

// Returns the change of the Lame parameters due to the shift.
Lame change(double modulus, double ratio, double shift) {
  const Lame before = lame(modulus, ratio), after = lame(modulus, std::clamp(ratio + shift, kLowest, kHighest));
  return {after.lambda - before.lambda, after.mu - before.mu};
}

class Compressibility : public PointwiseEffect {
 public:
  explicit Compressibility(const EffectContext& context) : PointwiseEffect(context.fem), solids_(context, 1) {}

  bool needs_elasticity() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    for (std::size_t s = 0; s < solids_.count(); ++s) {
      const auto here = [this, s](const Parameters& p) { return shifted(s, p); };
      add(out, s, isotropic_factor(1.0, 0.0), [here](const Parameters& p) { return here(p).lambda; });
      add(out, s, isotropic_factor(0.0, 1.0), [here](const Parameters& p) { return here(p).mu; });
    }
  }
  void add_stress(int e, int, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    solids_.at(e, [&](std::size_t s) { stress += neo_hookean_stress(shifted(s, p), f); });
  }
  void add_tangent(int e, int, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    solids_.at(e, [&](std::size_t s) { tangent += neo_hookean_tangent(shifted(s, p), f); });
  }
  bool has_strain_form() const override { return true; }
  void add_strain_force(const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains, const Parameters& p,
                        double scale, Eigen::VectorXd& force) const override {
    for (std::size_t s = 0; p[0] != 0.0 && s < solids_.count(); ++s) {
      solids_.finite(s).add_strain_force(scaled(shifted(s, p), scale), u, strains, everywhere, force);
    }
  }
  void add_strain_tangent(const Eigen::VectorXd& u, const Parameters& p, double scale,
                          SparseMatrix& stiffness) const override {
    for (std::size_t s = 0; p[0] != 0.0 && s < solids_.count(); ++s) {
      solids_.finite(s).add_strain_tangent(scaled(shifted(s, p), scale), u, everywhere, stiffness);
    }
  }
  Lame rest_moduli(int e, int, const Parameters& p) const override {
    Lame sum{0.0, 0.0};
    solids_.at(e, [&](std::size_t s) { sum = {sum.lambda + shifted(s, p).lambda, sum.mu + shifted(s, p).mu}; });
    return sum;
  }

 private:
  static double everywhere(int, int) { return 1.0; }
  static Lame scaled(const Lame& c, double by) { return {by * c.lambda, by * c.mu}; }
  Lame shifted(std::size_t s, const Parameters& p) const {
    return change(solids_.modulus(s, p), solids_.ratio(s, p), p[0]);
  }
  bool is_absent(const Parameters& p) const override { return p[0] == 0.0; }
  double energy_density(int e, int, const Eigen::Matrix3d& f, const Parameters& p) const override {
    double sum = 0.0;
    solids_.at(e, [&](std::size_t s) { sum += neo_hookean_energy(shifted(s, p), f); });
    return sum;
  }
  void add(LinearTerms& out, std::size_t s, const StrainFactor& factor, Coefficient coefficient) const {
    StrainTerm term;
    term.factor = [this, s, factor](int e, int, const Parameters&) {
      return solids_.holds(s, e) ? factor : StrainFactor(6, 0);
    };
    term.coefficient = std::move(coefficient);
    out.strain_stiffness.push_back(std::move(term));
  }

  Solids solids_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("compressibility")) return {};
  const EffectEntry entry{"compressibility", {{"shift", normal_prior(0.0, 0.05)}}};
  return {{entry, "shift", entry}};
}

}  // namespace

EffectSpec compressibility_spec() {
  EffectSpec spec;
  spec.name = "compressibility";
  spec.summary = "shift of Poisson's ratio of every elasticity, kept between -0.9 and 0.4999";
  spec.formula = "sigma(E, nu + shift) - sigma(E, nu)";
  spec.source = "Hooke's law";
  spec.parameters = {{"shift", "d nu", "-", -1.0, 1.0, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_compressibility(const Value&, const EffectContext& context) {
  return std::make_unique<Compressibility>(context);
}

}  // namespace tissue_stiffness::effects
