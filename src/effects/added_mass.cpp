// Extra mass is attached to the surface. It slows the motion, and gravity acts on it.
#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

class AddedMass : public Effect {
 public:
  AddedMass(const Value& arguments, const EffectContext& context) {
    const Region& region = context.region(arguments.at("region"));
    SparseMatrix mass = region.facets.empty() ? on_nodes(region, context.fem) : facet_mass(context.mesh, region.facets);
    mass *= 3.0 / mass.sum();
    unit_mass_ = share_matrix(std::move(mass));
  }

  void linear_terms(LinearTerms& out) const override {
    out.mass.push_back({unit_mass_, [](const Parameters& p) { return p[0]; }});
  }

 private:
  static SparseMatrix on_nodes(const Region& region, const Discretisation& fem) {
    SparseMatrix shares(fem.dof_count(), fem.dof_count());
    for (const int node : region.nodes) {
      for (int i = 0; i < 3; ++i) shares.insert(3 * node + i, 3 * node + i) = 1.0;
    }
    return shares;
  }

  std::shared_ptr<const SparseMatrix> unit_mass_;
};

// Proposes a mass on every named surface that is not held.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("added_mass")) return {};
  const Eigen::Vector3d edges = context.high() - context.low();
  const double scale = 0.05 * context.density * edges.prod();
  std::vector<Proposal> list;
  for (const auto& [name, region] : context.regions) {
    if (region.nodes.empty() || context.names("fixed", name)) continue;
    const auto with = [&where = name](const Quantity& mass) {
      return EffectEntry{"added_mass", {{"region", where}, {"mass", mass}}};
    };
    list.push_back({with(normal_prior(0.0, scale)), "mass", with(log_normal_prior(scale, 4.0)), {"region"}});
  }
  return list;
}

}  // namespace

EffectSpec added_mass_spec() {
  EffectSpec spec;
  spec.name = "added_mass";
  spec.summary = "mass glued evenly to a part of the surface; gravity weighs it";
  spec.formula = "m int N_a N_b dA / A";
  spec.source = "rigid layer without rotary inertia";
  spec.parameters = {{"mass", "m", "kg", 0.0, 1e4, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.keys = {{"region", "facets (or, where it holds none, nodes) that carry it"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_added_mass(const Value& arguments, const EffectContext& context) {
  return std::make_unique<AddedMass>(arguments, context);
}

}  // namespace tissue_stiffness::effects
