// Extra mass is attached to the body. It slows the motion, and gravity acts on it.
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "effects/registry.hpp"
#include "effects/spread_points.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

enum Index { kMass, kX, kY, kZ };
constexpr int kPlaces = 24;      // tried in a body, which is divided into about as many cells
constexpr double kWidth = 0.5;   // of a cell's edge: standard deviation of a lump
constexpr double kLeast = 1e-6;  // share of a lump below which a cell has none of it

// Returns the matrix of one kilogram that these nodes share.
SparseMatrix unit_mass(const std::vector<int>& nodes, const Discretisation& fem) {
  SparseMatrix mass(fem.dof_count(), fem.dof_count());
  for (const int node : nodes) {
    for (int i = 0; i < 3; ++i) mass.insert(3 * node + i, 3 * node + i) = 1.0 / static_cast<double>(nodes.size());
  }
  return mass;
}

SparseMatrix unit_mass(const Region& region, const EffectContext& context) {
  if (region.facets.empty()) return unit_mass(region.nodes, context.fem);
  SparseMatrix mass = facet_mass(context.mesh, region.facets);
  mass *= 3.0 / mass.sum();
  return mass;
}

class AddedMass : public Effect {
 public:
  AddedMass(const Value& arguments, const EffectContext& context) {
    if (arguments.has("region") == arguments.has("center")) {
      throw InputError(arguments.has("center") ? arguments.at("center").path() : arguments.path(),
                       arguments.has("center") ? "region and center" : "neither region nor center",
                       "one of `region` and `center`");
    }
    if (arguments.has("region")) {
      const Region& region = context.region(arguments.at("region"));
      cells_.push_back({Eigen::Vector3d::Zero(), share_matrix(unit_mass(region, context))});
    } else {
      divide(context.mesh, context.fem);
      const Value& center = arguments.at("center");
      if (center.type() == Value::Type::list) join_at(center.as_vector3("m"));
    }
  }

  void linear_terms(LinearTerms& out) const override {
    if (cells_.size() == 1) return out.mass.push_back({cells_[0].unit_mass, [](const Parameters& p) { return p[kMass]; }});
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      out.mass.push_back(
          {cells_[c].unit_mass, [this, c](const Parameters& p) { return p[kMass] * share(c, p.segment<3>(kX)); }});
    }
  }

 private:
  struct Cell {
    Eigen::Vector3d middle;
    std::shared_ptr<const SparseMatrix> unit_mass;
  };

  // Divides the nodes among the cells of a lattice. A lump at any place is then a sum of constant matrices.
  void divide(const TetMesh& mesh, const Discretisation& fem) {
    edge_ = std::cbrt(fem.volume() / kPlaces);
    const Eigen::Vector3d low = mesh.nodes.rowwise().minCoeff();
    std::map<std::array<int, 3>, std::vector<int>> nodes;
    for (int i = 0; i < mesh.node_count(); ++i) {
      const Eigen::Vector3d at = (mesh.nodes.col(i) - low) / edge_;
      nodes[{static_cast<int>(at[0]), static_cast<int>(at[1]), static_cast<int>(at[2])}].push_back(i);
    }
    for (const auto& [cell, list] : nodes) {
      Eigen::Vector3d middle = Eigen::Vector3d::Zero();
      for (const int i : list) middle += mesh.nodes.col(i) / static_cast<double>(list.size());
      cells_.push_back({middle, share_matrix(unit_mass(list, fem))});
    }
  }

  // A place that is known needs one matrix only.
  void join_at(const Eigen::Vector3d& center) {
    SparseMatrix sum = *cells_.front().unit_mass * share(0, center);
    for (std::size_t c = 1; c < cells_.size(); ++c) {
      if (const double part = share(c, center); part > 0.0) sum += *cells_[c].unit_mass * part;
    }
    cells_ = {{center, share_matrix(std::move(sum))}};
  }

  double share(std::size_t cell, const Eigen::Vector3d& center) const {
    const auto log_weight = [&](const Cell& c) { return -0.5 * ((c.middle - center) / (kWidth * edge_)).squaredNorm(); };
    const double own = log_weight(cells_[cell]);
    double sum = 0.0;  // of all weights over the own one; infinite where that one is far
    for (const Cell& c : cells_) sum += std::exp(log_weight(c) - own);
    return sum * kLeast > 1.0 ? 0.0 : 1.0 / sum;
  }

  std::vector<Cell> cells_;  ///< one for a region or a known place
  double edge_ = 0.0;        ///< [m]
};

// Proposes a mass on every named surface that is not held, and at places that are spread evenly over the body.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("added_mass")) return {};
  const Eigen::Vector3d edges = context.high() - context.low();
  const double scale = 0.05 * context.density * edges.prod();
  const Quantity tangent = normal_prior(0.0, scale), refit = log_normal_prior(scale, 4.0);
  const auto with = [](const std::string& where, const Argument& place, const Quantity& mass) {
    return EffectEntry{"added_mass", {{where, place}, {"mass", mass}}};
  };
  std::vector<Proposal> list;
  for (const auto& [name, region] : context.regions) {
    if (region.nodes.empty() || context.names("fixed", name)) continue;
    list.push_back({with("region", name, tangent), "mass", with("region", name, refit), {"region"}});
  }
  const SpreadPoints places = spread_points(context.mesh, kPlaces);
  for (Eigen::Index i = 0; i < places.points.cols(); ++i) {
    const Eigen::Vector3d center = places.points.col(i);
    list.push_back({with("center", center, tangent),
                    "mass",
                    with("center", normal_prior(center, 0.5 * places.distance), refit),
                    {"region"}});
  }
  return list;
}

}  // namespace

EffectSpec added_mass_spec() {
  EffectSpec spec;
  spec.name = "added_mass";
  spec.summary = "mass glued evenly to a region, or a lump in the body; gravity weighs it";
  spec.formula = "m int N_a N_b dA / A; a lump: m sum_c s_c M_c over cells of the body, s_c ~ exp(-|x_c - c|^2 / (2 w^2))";
  spec.source = "rigid layer without rotary inertia";
  spec.parameters = {{"mass", "m", "kg", 0.0, 1e4, ParameterSpec::Default::required, 0.0, 0.0, 1},
                     {"center", "c", "m", -1e3, 1e3, ParameterSpec::Default::optional, 0.0, NAN, 3}};
  spec.keys = {{"region", "facets (or, where it holds none, nodes) that carry it, in place of `center`"}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_added_mass(const Value& arguments, const EffectContext& context) {
  return std::make_unique<AddedMass>(arguments, context);
}

}  // namespace tissue_stiffness::effects
