// Uniform gravity acts on every mass of the model.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class Gravity : public Effect {
 public:
  void linear_terms(LinearTerms& out) const override {
    for (int i = 0; i < 3; ++i) {
      out.acceleration[i].push_back([i](const Parameters& p) { return p[i]; });
    }
  }
};

// A declared gravity may be wrong, so a second entry may add the difference.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.estimates("gravity", "acceleration")) return {};
  const EffectEntry entry{"gravity", {{"acceleration", normal_prior(Eigen::Vector3d::Zero(), 6.0)}}};
  return {{entry, "acceleration", entry}};
}

}  // namespace

EffectSpec gravity_spec() {
  EffectSpec spec;
  spec.name = "gravity";
  spec.summary = "uniform gravity on every mass of the model";
  spec.formula = "M g";
  spec.source = "Yang & Lin 2016, eq. 4, third term";
  spec.parameters = {{"acceleration", "g", "m/s^2", -1e3, 1e3, ParameterSpec::Default::required, 0.0, 0.0, 3, 0.1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_gravity(const Value&, const EffectContext&) {
  return std::make_unique<Gravity>();
}

}  // namespace tissue_stiffness::effects
