// A force sensor has a wrong zero: a constant force acts in addition to the measured one.
#include <algorithm>

#include "effects/force_shares.hpp"
#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

class LoadOffset : public Effect {
 public:
  LoadOffset(const Value& arguments, const EffectContext& context)
      : weights_(force_shares(arguments.at("region"), context)) {}

  bool shareable() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    for (int i = 0; i < 3; ++i) {
      LoadTerm load;
      load.pattern = along_axis(weights_, i);
      load.coefficient = [i](const Parameters& p) { return p[i]; };
      out.loads.push_back(std::move(load));
    }
  }

 private:
  Eigen::VectorXd weights_;
};

// The prior is a force that bends the body by a hundredth of its size or less.
std::vector<Proposal> propose(const ProposalContext& context) {
  const Eigen::Vector3d edges = context.high() - context.low();
  const double scale = 1e-3 * context.young_modulus * edges.prod() / edges.maxCoeff();
  std::vector<Proposal> list;
  for (const std::string& name : context.regions_of("traction", "load_offset")) {
    const EffectEntry entry{"load_offset", {{"region", name}, {"force", normal_prior(Eigen::Vector3d::Zero(), scale)}}};
    list.push_back({entry, "force", entry, {"region"}});
  }
  return list;
}

}  // namespace

EffectSpec load_offset_spec() {
  EffectSpec spec;
  spec.name = "load_offset";
  spec.summary = "a constant force, spread evenly over a patch: the zero of a force sensor, or what leans on the patch";
  spec.formula = "F_0 int N_a dA / A";
  spec.source = "systematic error of a load's sensor: its zero";
  spec.parameters = {{"force", "F_0", "N", -1e4, 1e4, ParameterSpec::Default::required, 0.0, 0.0, 3}};
  spec.keys = {{"region", "facets it acts on; where it holds none, its vertices in equal parts"}};
  spec.proposals = propose;
  spec.of_recording = true;
  return spec;
}

std::unique_ptr<Effect> make_load_offset(const Value& arguments, const EffectContext& context) {
  return std::make_unique<LoadOffset>(arguments, context);
}

}  // namespace tissue_stiffness::effects
