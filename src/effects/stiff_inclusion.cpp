// A ball in the body has another stiffness.
#include <Eigen/Geometry>
#include <algorithm>

#include "effects/pointwise_effect.hpp"
#include "effects/registry.hpp"
#include "effects/solids.hpp"
#include "effects/spread_points.hpp"

namespace tissue_stiffness::effects {
namespace {

enum Index { kExcess, kX, kY, kZ, kRadius, kOwn };
constexpr double kEdge = 0.25;  // of an element's edge: half the width of the ball's edge, so that places can be estimated
constexpr int kPlaces = 24;     // tried in a body
constexpr double kSmall = 0.4, kLarge = 0.75;  // of the distance between places: radii tried

double mean_edge(const Discretisation& fem) {
  return std::cbrt(6.0 * std::sqrt(2.0) * fem.volume() / fem.element_count());
}

class StiffInclusion : public PointwiseEffect {
 public:
  explicit StiffInclusion(const EffectContext& context)
      : PointwiseEffect(context.fem),
        fem_(context.fem),
        solids_(context, kOwn),
        half_width_(kEdge * mean_edge(context.fem)) {}

  bool needs_elasticity() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    for (std::size_t s = 0; s < solids_.count(); ++s) {
      StrainTerm term;
      term.factor = [this, s](int e, int q, const Parameters& p) {
        const double share = solids_.holds(s, e) ? inside(e, q, p) : 0.0;
        if (share == 0.0) return StrainFactor(6, 0);
        const Lame unit = lame(1.0, solids_.ratio(s, p));
        return StrainFactor(std::sqrt(share) * isotropic_factor(unit.lambda, unit.mu));
      };
      term.coefficient = [this, s](const Parameters& p) { return p[kExcess] * solids_.modulus(s, p); };
      term.shape = {kX, kY, kZ, kRadius, solids_.ratio_index(s)};
      out.strain_stiffness.push_back(std::move(term));
    }
  }
  void add_stress(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    const double excess = excess_at(e, q, p);
    if (excess == 0.0) return;
    solids_.at(e, [&](std::size_t s) { stress += excess * neo_hookean_stress(solids_.moduli(s, p), f); });
  }
  void add_tangent(int e, int q, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    const double excess = excess_at(e, q, p);
    if (excess == 0.0) return;
    solids_.at(e, [&](std::size_t s) { tangent += excess * neo_hookean_tangent(solids_.moduli(s, p), f); });
  }
  Lame rest_moduli(int e, int q, const Parameters& p) const override {
    const double excess = excess_at(e, q, p);
    Lame sum{0.0, 0.0};
    solids_.at(e, [&](std::size_t s) {
      const Lame c = solids_.moduli(s, p);
      sum = {sum.lambda + excess * c.lambda, sum.mu + excess * c.mu};
    });
    return sum;
  }
  bool has_strain_form() const override { return true; }
  void add_strain_force(const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains, const Parameters& p,
                        double scale, Eigen::VectorXd& force) const override {
    for (std::size_t s = 0; p[kExcess] != 0.0 && s < solids_.count(); ++s) {
      const Lame c = lame(scale * solids_.modulus(s, p), solids_.ratio(s, p));
      solids_.finite(s).add_strain_force(c, u, strains, share(p), force);
    }
  }
  void add_strain_tangent(const Eigen::VectorXd& u, const Parameters& p, double scale,
                          SparseMatrix& stiffness) const override {
    for (std::size_t s = 0; p[kExcess] != 0.0 && s < solids_.count(); ++s) {
      const Lame c = lame(scale * solids_.modulus(s, p), solids_.ratio(s, p));
      solids_.finite(s).add_strain_tangent(c, u, share(p), stiffness);
    }
  }

 private:
  bool is_absent(const Parameters& p) const override { return p[kExcess] == 0.0; }
  double energy_density(int e, int q, const Eigen::Matrix3d& f, const Parameters& p) const override {
    const double excess = excess_at(e, q, p);
    if (excess == 0.0) return 0.0;
    double sum = 0.0;
    solids_.at(e, [&](std::size_t s) { sum += excess * neo_hookean_energy(solids_.moduli(s, p), f); });
    return sum;
  }

  // Returns 1 inside, 0 outside, and a smooth step in between.
  double inside(int e, int q, const Parameters& p) const {
    const double distance = (fem_.position(e, q) - Eigen::Vector3d(p.segment<3>(kX))).norm();
    const double x = std::clamp(0.5 + 0.5 * (p[kRadius] - distance) / half_width_, 0.0, 1.0);
    return x * x * x * (10.0 - 15.0 * x + 6.0 * x * x);
  }
  double excess_at(int e, int q, const Parameters& p) const { return p[kExcess] * inside(e, q, p); }

  // The result refers to p, because a copy would allocate memory at every force.
  PointShare share(const Parameters& p) const {
    return [this, &p](int e, int q) { return excess_at(e, q, p); };
  }

  const Discretisation& fem_;
  Solids solids_;
  double half_width_;
};

// Proposes places that are spread evenly over the body, with two sizes each.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("stiff_inclusion")) return {};
  const SpreadPoints places = spread_points(context.mesh, kPlaces);
  std::vector<Proposal> list;
  for (Eigen::Index i = 0; i < places.points.cols(); ++i) {
    const Eigen::Vector3d center = places.points.col(i);
    for (const double size : {kSmall, kLarge}) {
      const double radius = size * places.distance;
      const auto with = [](const Argument& center, const Argument& radius, const Quantity& excess) {
        return EffectEntry{"stiff_inclusion", {{"center", center}, {"radius", radius}, {"excess", excess}}};
      };
      list.push_back(
          {with(center, radius, normal_prior(0.0, 2.0)),
           "excess",
           with(normal_prior(center, 0.5 * places.distance), log_normal_prior(radius, 1.5), normal_prior(1.0, 3.0)),
           {},
           {"center", "radius"}});
    }
  }
  return list;
}

}  // namespace

EffectSpec stiff_inclusion_spec() {
  EffectSpec spec;
  spec.name = "stiff_inclusion";
  spec.summary = "a ball whose modulus is 1 + excess times that of the tissue around; softer below zero";
  spec.formula = "excess x the elastic stress inside, a smooth step over half an element's edge between";
  spec.source = "Eshelby 1957: inhomogeneity";
  spec.parameters = {{"excess", "r - 1", "-", -0.99, 1e4, ParameterSpec::Default::required, 0.0, 0.0, 1},
                     {"center", "c", "m", -1e3, 1e3, ParameterSpec::Default::required, 0.0, NAN, 3},
                     {"radius", "R", "m", 1e-6, 1e3, ParameterSpec::Default::required, 0.0, NAN, 1}};
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_stiff_inclusion(const Value&, const EffectContext& context) {
  return std::make_unique<StiffInclusion>(context);
}

}  // namespace tissue_stiffness::effects
