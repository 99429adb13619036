// Poisson's ratio differs from that of the model file.
#include <algorithm>

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

class Compressibility : public Effect, public FiniteStrainForm {
 public:
  explicit Compressibility(const EffectContext& context) : solids_(context, 1) {}

  bool needs_elasticity() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    for (std::size_t s = 0; s < solids_.count(); ++s) {
      const auto here = [this, s](const Parameters& p) { return change(solids_.modulus(s, p), solids_.ratio(s, p), p[0]); };
      add(out, s, isotropic_factor(1.0, 0.0), [here](const Parameters& p) { return here(p).lambda; });
      add(out, s, isotropic_factor(0.0, 1.0), [here](const Parameters& p) { return here(p).mu; });
    }
  }
  const FiniteStrainForm* finite_strain() const override { return this; }
  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    for (std::size_t s = 0; p[0] != 0.0 && s < solids_.count(); ++s) {
      solids_.finite(s).add_force(change(solids_.modulus(s, p), solids_.ratio(s, p), p[0]), motion.displacement, force);
    }
  }
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    for (std::size_t s = 0; p[0] != 0.0 && s < solids_.count(); ++s) {
      const Lame c = change(solids_.modulus(s, p), solids_.ratio(s, p), p[0]);
      solids_.finite(s).add_stiffness(c, motion.displacement, stiffness);
    }
  }

 private:
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
