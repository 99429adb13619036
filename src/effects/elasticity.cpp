// Elastic resistance, at small strain (linear) or finite strain (neo_hookean).
#include <numeric>

#include "effects/registry.hpp"
#include "fem/neo_hookean.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

double everywhere(int, int) {
  return 1.0;
}

class Elasticity : public Effect, public FiniteStrainForm, public PointForm {
 public:
  Elasticity(const Value& arguments, const EffectContext& context)
      : elements_(solid_elements(arguments, context.fem.element_count(), context.regions)), solid_(context.fem, elements_) {
    finite_strain_ = arguments.at("law").as_choice({"linear", "neo_hookean"}) == "neo_hookean";
    Eigen::VectorXd inside = Eigen::VectorXd::Zero(context.fem.element_count());
    for (const int e : elements_) inside[e] = 1.0;
    inside_.assign(inside.data(), inside.data() + inside.size());
    const auto kept = [&](SparseMatrix&& part) {
      if (arguments.has("region")) {  // of many regions each keeps its own entries alone
        part.prune(0.0);
        part.data().squeeze();
      }
      return share_matrix(std::move(part));
    };
    SparseMatrix volumetric = context.fem.volumetric_stiffness(inside);
    const Quantity ratio = read_parameters({"elasticity", "elasticity", arguments})[1];
    if (ratio.estimated()) {
      SparseMatrix shear = volumetric;
      context.fem.make_elastic(0.0, 1.0, shear);
      linear_.push_back({kept(std::move(volumetric)), [](const Parameters& p) { return lame(p[0], p[1]).lambda; }});
      linear_.push_back({kept(std::move(shear)), [](const Parameters& p) { return lame(p[0], p[1]).mu; }});
      return;
    }
    const Lame unit = lame(1.0, ratio.value);
    context.fem.make_elastic(unit.lambda, unit.mu, volumetric);
    linear_.push_back({kept(std::move(volumetric)), [](const Parameters& p) { return p[0]; }});
  }

  bool shareable() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    out.stiffness.insert(out.stiffness.end(), linear_.begin(), linear_.end());
  }
  const FiniteStrainForm* finite_strain() const override { return this; }
  bool always_finite() const override { return finite_strain_; }
  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    solid_.add_force(lame(p[0], p[1]), motion.displacement, force);
  }
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    solid_.add_stiffness(lame(p[0], p[1]), motion.displacement, stiffness);
  }
  bool has_strain_form() const override { return true; }
  void add_strain_force(const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains, const Parameters& p,
                        double scale, Eigen::VectorXd& force) const override {
    solid_.add_strain_force(lame(scale * p[0], p[1]), u, strains, everywhere, force);
  }
  void add_strain_tangent(const Eigen::VectorXd& u, const Parameters& p, double scale,
                          SparseMatrix& stiffness) const override {
    solid_.add_strain_tangent(lame(scale * p[0], p[1]), u, everywhere, stiffness);
  }
  const PointForm* point_form() const override { return this; }
  void add_stress(int e, int, const Eigen::Matrix3d& f, const Parameters& p, Eigen::Matrix3d& stress) const override {
    if (holds(e)) stress += neo_hookean_stress(lame(p[0], p[1]), f);
  }
  void add_tangent(int e, int, const Eigen::Matrix3d& f, const Parameters& p, StressTangent& tangent) const override {
    if (holds(e)) tangent += neo_hookean_tangent(lame(p[0], p[1]), f);
  }
  Lame rest_moduli(int e, int, const Parameters& p) const override { return holds(e) ? lame(p[0], p[1]) : Lame{0.0, 0.0}; }
  double energy(const Motion& motion, const Parameters& p) const override {
    const Eigen::VectorXd& u = motion.displacement;
    double sum = 0.0;
    if (motion.finite_share > 0.0) sum += motion.finite_share * solid_.energy(lame(p[0], p[1]), u);
    for (const MatrixTerm& term : linear_) {
      if (motion.finite_share < 1.0)
        sum += (1.0 - motion.finite_share) * 0.5 * term.coefficient(p) * u.dot(*term.matrix * u);
    }
    return sum;
  }

 private:
  bool holds(int e) const { return inside_[static_cast<std::size_t>(e)] != 0; }

  std::vector<int> elements_;
  std::vector<char> inside_;  ///< for each element: whether it is one of them
  NeoHookean solid_;
  bool finite_strain_ = false;
  std::vector<MatrixTerm> linear_;  ///< one alone where Poisson's ratio is known
};

}  // namespace

EffectSpec elasticity_spec() {
  EffectSpec spec;
  spec.name = "elasticity";
  spec.summary = "elastic resistance of the tissue, isotropic";
  spec.formula = "linear: sigma = lambda tr(eps) I + 2 mu eps; neo_hookean: P = mu (F - F^-T) + lambda ln J F^-T";
  spec.source = "Yang & Lin 2016, eq. 4, second term; Bonet & Wood 2008, eq. 6.29";
  spec.parameters = {{"young_modulus", "E", "Pa", 1.0, 1e12, ParameterSpec::Default::required, 0.0, NAN, 1},
                     {"poisson_ratio", "nu", "-", -0.9, 0.4999, ParameterSpec::Default::required, 0.0, NAN, 1, 0.01}};
  spec.keys = {{"law", "linear | neo_hookean"}, {"region", "tetrahedra it fills; without it the whole body"}};
  return spec;
}

std::unique_ptr<Effect> make_elasticity(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Elasticity>(arguments, context);
}

}  // namespace tissue_stiffness::effects

namespace tissue_stiffness {

std::vector<int> solid_elements(const Value& arguments, int element_count, const std::map<std::string, Region>& regions) {
  if (!arguments.has("region")) {
    std::vector<int> all(static_cast<std::size_t>(element_count));
    std::iota(all.begin(), all.end(), 0);
    return all;
  }
  const Value& name = arguments.at("region");
  const std::vector<int>& inside = find_region(name, regions).tets;
  if (inside.empty()) throw InputError(name.path(), name.shown(), "a region that holds tetrahedra");
  return inside;
}

}  // namespace tissue_stiffness
