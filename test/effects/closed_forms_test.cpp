// Laws of finite strain against closed forms: uniaxial and equibiaxial stretch, simple shear, an inflated sphere.
#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <functional>

#include "../box_model.hpp"
#include "forward/model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kModulus = 3e4, kRatio = 0.4, kMu = kModulus / (2.0 * (1.0 + kRatio));

// Energies of incompressible solids along a path, by hand: psi(F(l)), with the principal stretches and F.
struct Case {
  std::string name, effect;
  std::function<double(const Eigen::Vector3d& stretches, const Eigen::Matrix3d& f)> energy;  ///< [Pa]
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

double powers(const Eigen::Vector3d& l, double exponent) {
  return l.array().pow(exponent).sum() - 3.0;
}
double neo_hookean(const Eigen::Vector3d& l, const Eigen::Matrix3d&) {
  return 0.5 * kMu * powers(l, 2.0);
}
double mooney_rivlin(const Eigen::Vector3d& l, const Eigen::Matrix3d&) {  // C10 = 0.6 mu / 2, C01 = 0.4 mu / 2
  return 0.5 * kMu * (0.6 * powers(l, 2.0) + 0.4 * powers(l, -2.0));
}
double ogden(const Eigen::Vector3d& l, const Eigen::Matrix3d&) {
  return 2.0 * kMu / (4.7 * 4.7) * powers(l, -4.7);
}
double stiffening(const Eigen::Vector3d& l, const Eigen::Matrix3d&) {  // E/(2 b) (exp(2 b psi / E) - 1)
  return kModulus / 10.0 * std::expm1(10.0 / kModulus * 0.5 * kMu * powers(l, 2.0));
}
double collagen(const Eigen::Vector3d& l, const Eigen::Matrix3d& f) {  // k1 = 1e4, k2 = 2, kappa = 0.1, along x
  const double x = 0.1 * powers(l, 2.0) + 0.7 * (f.col(0).squaredNorm() - 1.0);
  return neo_hookean(l, f) + (x > 0.0 ? 1e4 / 4.0 * std::expm1(2.0 * x * x) : 0.0);
}

const Case kNeoHookean{"neo_hookean", "gravity: {acceleration: [0, 0, 1]}", neo_hookean};
const Case kMooneyRivlin{"mooney_rivlin", "mooney_rivlin: {share: 0.4}", mooney_rivlin};
const Case kOgden{"ogden", "ogden: {exponent: -4.7}", ogden};
const Case kStiffening{"strain_stiffening", "strain_stiffening: {exponent: 5}", stiffening};
const Case kCollagen{"holzapfel_gasser_ogden",
                     "holzapfel_gasser_ogden: {direction: [1, 0, 0], stiffness: 1e4, exponent: 2, dispersion: 0.1}",
                     collagen};

std::vector<std::string> body_of(const Case& law) {
  std::vector<std::string> list;  // filled one by one: GCC 12 sees an overflow in a list of these that is then extended
  list.emplace_back("inertia: {density: 1000}");
  list.emplace_back("elasticity: {law: neo_hookean, young_modulus: 3e4, poisson_ratio: 0.4}");
  list.push_back(law.effect);
  return list;
}

class ClosedForm : public testing::TestWithParam<Case> {
 protected:
  ClosedForm() : model_(box_settings(body_of(GetParam())), bar_mesh(2)), point_(model_.point(model_.prior_theta())) {}

  Eigen::Matrix3d stress(const Eigen::Matrix3d& f) const {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < model_.parts().size(); ++i) {
      const FiniteStrainForm* form = model_.parts()[i].effect->finite_strain();
      if (form != nullptr) form->point_form()->add_stress(0, 0, f, point_.parts[i].parameters, sum);
    }
    return sum;
  }
  // Along a path of constant volume the stress does the work that the energy by hand tells, whatever the pressure.
  void expect_work(const std::function<Eigen::Matrix3d(double)>& path, const std::vector<double>& at) const {
    constexpr double kStep = 1e-5;
    for (const double x : at) {
      const auto energy = [&](double l) {
        const Eigen::Matrix3d f = path(l);
        return GetParam().energy(Eigen::JacobiSVD<Eigen::Matrix3d>(f).singularValues(), f);
      };
      const Eigen::Matrix3d rate = (path(x + kStep) - path(x - kStep)) / (2.0 * kStep);
      const double wanted = (energy(x + kStep) - energy(x - kStep)) / (2.0 * kStep);
      EXPECT_NEAR(stress(path(x)).cwiseProduct(rate).sum(), wanted, 1e-6 * (std::abs(wanted) + 1.0)) << "at " << x;
    }
  }

  const Model model_;
  const Model::Point point_;
};

TEST_P(ClosedForm, OfUniaxialStretch) {
  const auto path = [](double l) -> Eigen::Matrix3d {
    return Eigen::Vector3d(l, 1.0 / std::sqrt(l), 1.0 / std::sqrt(l)).asDiagonal();
  };
  expect_work(path, {0.7, 0.9, 1.1, 1.5});
}

TEST_P(ClosedForm, OfEquibiaxialStretch) {
  const auto path = [](double l) -> Eigen::Matrix3d { return Eigen::Vector3d(l, l, 1.0 / (l * l)).asDiagonal(); };
  expect_work(path, {0.8, 1.1, 1.4});
}

TEST_P(ClosedForm, OfSimpleShear) {
  const auto path = [](double shear) {
    Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
    f(0, 1) = shear;
    return f;
  };
  expect_work(path, {-0.4, 0.1, 0.5});
}

// Isotropic solids, whatever their law: sigma_xx - sigma_yy = shear sigma_xy (Rivlin 1948).
TEST_P(ClosedForm, KeepsTheUniversalRelationOfShear) {
  if (GetParam().name == kCollagen.name) return;
  Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
  f(0, 1) = 0.5;
  const Eigen::Matrix3d cauchy = stress(f) * f.transpose();
  EXPECT_NEAR(cauchy(0, 0) - cauchy(1, 1), 0.5 * cauchy(0, 1), 1e-10 * std::abs(cauchy(0, 1)));
}

INSTANTIATE_TEST_SUITE_P(Laws, ClosedForm, testing::Values(kNeoHookean, kMooneyRivlin, kOgden, kStiffening, kCollagen),
                         [](const auto& info) { return info.param.name; });

// A sixth of a hollow sphere, inner radius 1, outer radius 2: the cube's face that looks along z.
TetMesh sphere_sector(int cells) {
  TetMesh mesh = make_box_mesh({1.0, 1.0, 1.0}, cells, cells, 2 * cells, 2);
  for (Eigen::Index i = 0; i < mesh.nodes.cols(); ++i) {
    const Eigen::Vector3d x = mesh.nodes.col(i);
    const Eigen::Vector3d direction(std::tan(0.5 * M_PI * (x.x() - 0.5)), std::tan(0.5 * M_PI * (x.y() - 0.5)), 1.0);
    mesh.nodes.col(i) = (1.0 + x.z()) * direction.normalized();
  }
  return mesh;
}

// Pressure inside a sphere of incompressible tissue that keeps r^3 - R^3 = grown: p = int W'(l) / (l^3 - 1) dl from the
// outer hoop stretch to the inner one, with W the energy of equibiaxial stretch (Ogden 1984, sec. 5.3.2).
double inflation_pressure(const Case& law, double grown) {
  const auto hoop = [&](double radius) { return std::cbrt(1.0 + grown / (radius * radius * radius)); };
  const auto integrand = [&](double l) {
    constexpr double kStep = 1e-5;
    const auto energy = [&](double x) { return law.energy({x, x, 1.0 / (x * x)}, Eigen::Matrix3d::Identity()); };
    return (energy(l + kStep) - energy(l - kStep)) / (2.0 * kStep) / (l * l * l - 1.0);
  };
  constexpr int kIntervals = 200;  // Simpson's rule
  const double from = hoop(2.0), width = (hoop(1.0) - from) / kIntervals;
  double sum = 0.0;
  for (int k = 0; k <= kIntervals; ++k) {
    const double weight = k == 0 || k == kIntervals ? 1.0 : (k % 2 == 1 ? 4.0 : 2.0);
    sum += weight * integrand(from + k * width);
  }
  return sum * width / 3.0;
}

class InflatedSphere : public testing::TestWithParam<Case> {};

// The elements' forces do the work of that pressure where the sphere grows: f du/dgrown = p dV/dgrown, and a sixth of the
// cavity's volume is 4 pi (1 + grown) / 18.
TEST_P(InflatedSphere, HoldsThePressureOfTheClosedForm) {
  const Model model(box_settings(body_of(GetParam())), sphere_sector(3));
  const Model::Point point = model.point(model.prior_theta());
  for (const double grown : {0.3, 1.5}) {
    Eigen::VectorXd u(3 * model.mesh().node_count()), rate = u, force = Eigen::VectorXd::Zero(u.size());
    for (int i = 0; i < model.mesh().node_count(); ++i) {
      const Eigen::Vector3d x = model.mesh().nodes.col(i);
      const double before = x.norm(), after = std::cbrt(before * before * before + grown);
      u.segment<3>(3 * i) = (after / before - 1.0) * x;
      rate.segment<3>(3 * i) = x / before / (3.0 * after * after);
    }
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(u.size());
    for (std::size_t i = 0; i < model.parts().size(); ++i) {
      const FiniteStrainForm* form = model.parts()[i].effect->finite_strain();
      if (form != nullptr) form->add_finite_force({0.0, u, still, 1.0}, point.parts[i].parameters, force);
    }
    const double pressure = -force.dot(rate) * 18.0 / (4.0 * M_PI), wanted = inflation_pressure(GetParam(), grown);
    std::printf("%s: pressure %.1f Pa, closed form %.1f Pa\n", GetParam().name.c_str(), pressure, wanted);
    EXPECT_NEAR(pressure, wanted, 0.01 * wanted);
  }
}

INSTANTIATE_TEST_SUITE_P(Laws, InflatedSphere, testing::Values(kNeoHookean, kMooneyRivlin, kOgden, kStiffening),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace tissue_stiffness
