// The point form of every effect that has one, against its form in finite elements.
#include <gtest/gtest.h>

#include "../box_model.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

struct Case {
  std::string name, effect;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class PointFormOf : public testing::TestWithParam<Case> {
 protected:
  PointFormOf() : model_(box_settings(effects()), bar_mesh(3, 1, 1)), point_(model_.point(model_.prior_theta())) {
    srand(3);
    u_ = 1.5e-3 * Eigen::VectorXd::Random(model_.fem().dof_count());
    v_ = Eigen::VectorXd::Random(u_.size());
  }
  static std::vector<std::string> effects() {
    std::vector<std::string> list;  // filled one by one: GCC 12 sees an overflow in a list of these that is then extended
    list.emplace_back("inertia: {density: 1000}");
    list.emplace_back("fixed: {region: clamp}");
    if (GetParam().name != "elasticity")
      list.emplace_back("elasticity: {law: neo_hookean, young_modulus: 3e4, poisson_ratio: 0.4}");
    list.push_back(GetParam().effect);
    return list;
  }
  std::size_t part() const { return model_.parts().size() - 1; }
  const PointForm& form() const { return *model_.parts()[part()].effect->finite_strain()->point_form(); }
  const Eigen::VectorXd& parameters() const { return point_.parts[part()].parameters; }

  // Calls act(e, q, gradients of the shapes, F) at every quadrature point of a displacement.
  template <typename Act>
  void at_points(const Eigen::VectorXd& u, const Act& act) const {
    const Discretisation& fem = model_.fem();
    for (int e = 0; e < fem.element_count(); ++e) {
      for (int q = 0; q < fem.points_per_element(); ++q) {
        Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
        for (int a = 0; a < fem.nodes_per_element(); ++a) {
          f += u.segment<3>(3 * fem.elements()(a, e)) * fem.gradient(e, q).col(a).transpose();
        }
        act(e, q, f);
      }
    }
  }
  Eigen::VectorXd spread(int e, int q, const Eigen::Matrix3d& stress) const {
    const Discretisation& fem = model_.fem();
    Eigen::VectorXd out = Eigen::VectorXd::Zero(fem.dof_count());
    for (int a = 0; a < fem.nodes_per_element(); ++a) {
      out.segment<3>(3 * fem.elements()(a, e)) = fem.weight(e, q) * stress * fem.gradient(e, q).col(a);
    }
    return out;
  }

  const Model model_;
  const Model::Point point_;
  Eigen::VectorXd u_, v_;
};

TEST_P(PointFormOf, SumsToTheForceOfTheElements) {
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(u_.size()), sum = whole;
  model_.parts()[part()].effect->finite_strain()->add_finite_force({0.0, u_, v_, 1.0}, parameters(), whole);
  at_points(u_, [&](int e, int q, const Eigen::Matrix3d& f) {
    Eigen::Matrix3d stress = Eigen::Matrix3d::Zero();
    form().add_stress(e, q, f, parameters(), stress);
    sum -= spread(e, q, stress);
  });
  EXPECT_GT(whole.norm(), 0.0);
  EXPECT_LT((sum - whole).norm(), 1e-12 * whole.norm());
}

TEST_P(PointFormOf, HasTheDerivativeOfItsStress) {
  constexpr double kStep = 1e-6;
  at_points(u_, [&](int e, int q, const Eigen::Matrix3d& f) {
    if (e % 7 != 0) return;
    StressTangent tangent = StressTangent::Zero(), numerical;
    form().add_tangent(e, q, f, parameters(), tangent);
    for (int k = 0; k < 9; ++k) {
      Eigen::Matrix3d more = f, less = f, up = Eigen::Matrix3d::Zero(), down = up;
      more.data()[k] += kStep;
      less.data()[k] -= kStep;
      form().add_stress(e, q, more, parameters(), up);
      form().add_stress(e, q, less, parameters(), down);
      numerical.col(k) = Eigen::Map<const Eigen::Matrix<double, 9, 1>>(Eigen::Matrix3d((up - down) / (2.0 * kStep)).data());
    }
    EXPECT_LE((tangent - numerical).norm(), 1e-6 * numerical.norm()) << e;
    EXPECT_LE((tangent - tangent.transpose()).norm(), 1e-12 * tangent.norm()) << e;
  });
}

TEST_P(PointFormOf, DampsAsTheElementsDo) {
  const FiniteStrainForm& law = *model_.parts()[part()].effect->finite_strain();
  if (!law.has_strain_form()) return;
  const Discretisation& fem = model_.fem();
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(u_.size()), sum = whole, rates(strain_count(fem));
  green_strain_rates(fem, u_, v_, rates);
  law.add_strain_force(u_, rates, parameters(), 0.7, whole);
  at_points(u_, [&](int e, int q, const Eigen::Matrix3d& f) {
    Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();
    for (int a = 0; a < fem.nodes_per_element(); ++a) {
      rate += v_.segment<3>(3 * fem.elements()(a, e)) * fem.gradient(e, q).col(a).transpose();
    }
    const Lame rest = form().rest_moduli(e, q, parameters()), viscosity{0.7 * rest.lambda, 0.7 * rest.mu};
    const Eigen::Matrix3d stress = viscous_stress(viscosity, f, rate);
    sum -= spread(e, q, stress);
    const Eigen::Matrix<double, 9, 1> linear =
        viscous_tangent(viscosity, f) * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(rate.data());
    EXPECT_LE((linear - Eigen::Map<const Eigen::Matrix<double, 9, 1>>(stress.data())).norm(), 1e-12 * linear.norm());
  });
  EXPECT_GT(whole.norm(), 0.0);
  EXPECT_LT((sum - whole).norm(), 1e-12 * whole.norm());
}

INSTANTIATE_TEST_SUITE_P(
    Effects, PointFormOf,
    testing::Values(Case{"elasticity", "elasticity: {law: neo_hookean, young_modulus: 3e4, poisson_ratio: 0.4}"},
                    Case{"strain_stiffening", "strain_stiffening: {exponent: 5}"},
                    Case{"stiff_inclusion", "stiff_inclusion: {center: [0.05, 0.01, 0.01], radius: 0.03, excess: 2}"},
                    Case{"compressibility", "compressibility: {shift: 0.05}"},
                    Case{"fibre_reinforcement", "fibre_reinforcement: {direction: [1, 0.2, 0.1], modulus: 1e4}"},
                    Case{"mooney_rivlin", "mooney_rivlin: {share: 0.4}"}, Case{"ogden", "ogden: {exponent: -4.7}"},
                    Case{"holzapfel_gasser_ogden",
                         "holzapfel_gasser_ogden: {direction: [1, 0.2, 0.1], stiffness: 1e4, "
                         "exponent: 2, dispersion: 0.1}"}),
    [](const auto& info) { return info.param.name; });

// A point that is turned inside out has no stress.
TEST(PointForm, RefusesWhatIsTurnedInsideOut) {
  EXPECT_THROW(neo_hookean_stress({1.0, 1.0}, -Eigen::Matrix3d::Identity()), NumericalError);
  EXPECT_THROW(neo_hookean_tangent({1.0, 1.0}, Eigen::Matrix3d::Zero()), NumericalError);
}

}  // namespace
}  // namespace tissue_stiffness
