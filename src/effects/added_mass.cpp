// Extra mass glued to the surface: it slows the motion, and gravity weighs it.
#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

class AddedMass : public Effect {
 public:
  AddedMass(const Value& arguments, const EffectContext& context) : unit_mass_(context.fem.pattern()) {
    const Region& region = context.region(arguments.at("region"));
    region.facets.empty() ? spread_on_nodes(region, context) : spread_on_facets(region, context);
  }

  void linear_terms(LinearTerms& out) const override {
    out.mass.push_back({unit_mass_, [](const Parameters& p) { return p[0]; }});
  }

 private:
  void spread_on_nodes(const Region& region, const EffectContext&) {
    const double share = 1.0 / static_cast<double>(region.nodes.size());
    for (const int node : region.nodes) {
      for (int i = 0; i < 3; ++i) unit_mass_.coeffRef(3 * node + i, 3 * node + i) += share;
    }
  }

  void spread_on_facets(const Region& region, const EffectContext& context) {
    const TetMesh& mesh = context.mesh;
    const FacetQuadrature rule(static_cast<int>(mesh.facets.rows()));
    double total = 0.0;
    for (const int f : region.facets) {
      const Eigen::Matrix3Xd x = facet_nodes(mesh, f);
      const std::vector<int> local = facet_local_nodes(mesh, f);
      for (int q = 0; q < rule.points(); ++q) {
        const double area = rule.weight(q) * rule.normal(x, q).norm();
        total += area;
        for (std::size_t b = 0; b < local.size(); ++b) {
          for (std::size_t a = 0; a < local.size(); ++a) {
            const double n = rule.shape(q)[static_cast<Eigen::Index>(a)] * rule.shape(q)[static_cast<Eigen::Index>(b)];
            context.fem.add_block(unit_mass_, mesh.facet_tet[f], local[a], local[b],
                                  area * n * Eigen::Matrix3d::Identity());
          }
        }
      }
    }
    unit_mass_ *= 1.0 / total;
  }

  SparseMatrix unit_mass_;
};

}  // namespace

EffectSpec added_mass_spec() {
  EffectSpec spec;
  spec.name = "added_mass";
  spec.summary = "mass glued evenly to a part of the surface; gravity weighs it";
  spec.formula = "m int N_a N_b dA / A";
  spec.source = "rigid layer without rotary inertia";
  spec.parameters = {{"mass", "m", "kg", 0.0, 1e4, ParameterSpec::Default::required, 0.0, 0.0, 1}};
  spec.keys = {{"region", "facets (or, where it holds none, nodes) that carry it"}};
  return spec;
}

std::unique_ptr<Effect> make_added_mass(const Value& arguments, const EffectContext& context) {
  return std::make_unique<AddedMass>(arguments, context);
}

}  // namespace tissue_stiffness::effects
