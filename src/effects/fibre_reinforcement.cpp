// One family of fibres resists stretching.
#include "effects/fibre_field.hpp"
#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class FibreReinforcement : public PointwiseEffect {
 public:
  FibreReinforcement(const Value& arguments, const EffectContext& context)
      : PointwiseEffect(context.fem), fibres_(arguments, context) {}

  void linear_terms(LinearTerms& out) const override {
    StrainTerm term;
    term.factor = [this](int e, int q, const Parameters& p) {
      return StrainFactor(strain_of(fibres_.direction(e, q, p[1], p[2])));
    };
    term.coefficient = [](const Parameters& p) { return p[0]; };
    term.shape = {1, 2};
    out.strain_stiffness.push_back(std::move(term));
  }
  void add_stress(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    const Eigen::Vector3d a = direction(e, q, p);
    add_fibre_stress(tension(fibre_strain(f, a), p), a, f, stress);
  }
  void add_tangent(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    const Eigen::Vector3d a = direction(e, q, p);
    add_fibre_tangent(tension(fibre_strain(f, a), p), a, f, tangent);
  }

 private:
  Eigen::Vector3d direction(int e, int q, const Parameters& p) const { return fibres_.direction(e, q, p[1], p[2]); }
  static FibreTension tension(double strain, const Parameters& p) { return {p[0] * strain, p[0]}; }
  bool is_absent(const Parameters& p) const override { return p[0] == 0.0; }
  double energy_density(int e, int q, const Eigen::Matrix3d& f, const Parameters& p) const override {
    const double strain = fibre_strain(f, direction(e, q, p));
    return 0.5 * p[0] * strain * strain;
  }

  FibreField fibres_;
};

std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("fibre_reinforcement")) return {};
  const double scale = 0.5 * context.young_modulus;
  std::vector<Proposal> list;
  const auto add = [&](const FibreField::Trial& trial) {
    const auto with = [&trial](const Argument& angle, const Argument& tilt, const Quantity& modulus) {
      EffectEntry entry = FibreField::entry("fibre_reinforcement", trial, angle, tilt);
      entry.arguments.emplace_back("modulus", modulus);
      return entry;
    };
    Proposal proposal{with(trial.angle, 0.0, normal_prior(0.0, scale)), "modulus",
                      with(normal_prior(trial.angle, FibreField::kTurn), normal_prior(0.0, FibreField::kTurn),
                           log_normal_prior(scale, 3.0))};
    // Tangents choose between straight directions, because a fit turns them.
    if (!trial.straight) proposal.kind_keys = {"direction"};
    proposal.shape_keys = {"angle", "tilt"};
    list.push_back(std::move(proposal));
  };
  for (const FibreField::Trial& trial : FibreField::trials(context.mesh)) add(trial);
  for (const FibreField::Trial& trial : FibreField::oblique_trials()) add(trial);
  return list;
}

}  // namespace

EffectSpec fibre_reinforcement_spec() {
  EffectSpec spec;
  spec.name = "fibre_reinforcement";
  spec.summary = "one family of fibres that resists being stretched (and, alike, pressed)";
  spec.formula = "energy k/2 (a . eps a)^2; under finite strain k/2 ((|F a|^2 - 1)/2)^2";
  spec.source = "standard reinforcing model, Holzapfel 2000, sec. 6.7";
  spec.parameters = {{"modulus", "k", "Pa", 0.0, 1e12, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  for (const ParameterSpec& angle : FibreField::angles()) spec.parameters.push_back(angle);
  spec.keys = FibreField::keys();
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_fibre_reinforcement(const Value& arguments, const EffectContext& context) {
  return std::make_unique<FibreReinforcement>(arguments, context);
}

}  // namespace tissue_stiffness::effects
