// Tangents against finite differences, mass against integrals by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "tissue_stiffness/types/error.hpp"
#include "verification/elastic_body.hpp"

namespace tissue_stiffness {
namespace {

const Eigen::Vector3d kSize(0.10, 0.08, 0.06);
const Lame kLame = lame(20e3, 0.45);

// A displacement with strains of some tens of per cent.
Eigen::VectorXd large_displacement(const TetMesh& mesh) {
  return nodal(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {0.3 * x.x() + 0.02 * std::sin(20.0 * x.y()), -0.2 * x.y() + 2.0 * x.x() * x.z(), 0.01 * std::cos(15.0 * x.x())};
  });
}

TEST(NeoHookeanTangent, EqualsFiniteDifferencesOfTheForce) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = distorted_box(kSize, 2, order);
    const Discretisation fem(mesh);
    const NeoHookean solid(fem, all_elements(fem));
    const Eigen::VectorXd u = large_displacement(mesh);
    SparseMatrix tangent = fem.pattern();
    solid.add_stiffness(kLame, u, tangent);
    const double h = 1e-7, scale = tangent.diagonal().maxCoeff();
    double worst = 0.0;
    for (Eigen::Index j = 0; j < u.size(); ++j) {
      Eigen::VectorXd ahead = u, behind = u, f_ahead = Eigen::VectorXd::Zero(u.size()), f_behind = f_ahead;
      ahead[j] += h;
      behind[j] -= h;
      solid.add_force(kLame, ahead, f_ahead);
      solid.add_force(kLame, behind, f_behind);
      const Eigen::VectorXd column = -(f_ahead - f_behind) / (2.0 * h);
      worst = std::max(worst, (Eigen::VectorXd(tangent.col(j)) - column).cwiseAbs().maxCoeff() / scale);
    }
    std::printf("neo-Hookean tangent against differences, order %d: %.1e\n", order, worst);
    EXPECT_LT(worst, 1e-7);
  }
}

TEST(NeoHookeanTangent, ForceIsTheGradientOfTheEnergy) {
  const TetMesh mesh = distorted_box(kSize, 2, 2);
  const Discretisation fem(mesh);
  const NeoHookean solid(fem, all_elements(fem));
  const Eigen::VectorXd u = large_displacement(mesh), direction = random_vector(u.size(), 1.0, 5);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(u.size());
  solid.add_force(kLame, u, force);
  const double h = 1e-7;
  const double slope = (solid.energy(kLame, u + h * direction) - solid.energy(kLame, u - h * direction)) / (2.0 * h);
  EXPECT_NEAR(-force.dot(direction), slope, 1e-6 * std::abs(slope));
}

TEST(NeoHookeanTangent, IsTheSmallStrainStiffnessAtRest) {
  const TetMesh mesh = distorted_box(kSize, 2, 2);
  const Discretisation fem(mesh);
  SparseMatrix tangent = fem.pattern();
  NeoHookean(fem, all_elements(fem)).add_stiffness(kLame, Eigen::VectorXd::Zero(fem.dof_count()), tangent);
  const SparseMatrix linear = linear_stiffness(fem, kLame);
  EXPECT_LT((tangent - linear).norm(), 1e-13 * linear.norm());
}

TEST(NeoHookeanTangent, NamesTheElementThatTurnsInsideOut) {
  const TetMesh mesh = make_box_mesh(kSize, 1, 1, 1, 2);
  const Discretisation fem(mesh);
  const Eigen::VectorXd mirrored = nodal(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return {-2.0 * x.x(), 0.0, 0.0};
  });
  Eigen::VectorXd force = Eigen::VectorXd::Zero(fem.dof_count());
  try {
    NeoHookean(fem, all_elements(fem)).add_force(kLame, mirrored, force);
    FAIL() << "a mirrored body went through";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("tetrahedron 0"), std::string::npos) << error.what();
  }
}

TEST(Mass, TotalIsDensityTimesVolume) {
  for (const int order : {1, 2}) {
    const TetMesh mesh = distorted_box(kSize, 3, order);
    const Discretisation fem(mesh);
    EXPECT_NEAR(fem.volume(), kSize.prod(), 1e-14 * kSize.prod());
    const SparseMatrix mass = 1060.0 * fem.mass(Eigen::VectorXd::Ones(fem.element_count()));
    for (int i = 0; i < 3; ++i) {
      const Eigen::VectorXd unit = nodal(mesh, [i](const Eigen::Vector3d&) { return Eigen::Vector3d::Unit(i).eval(); });
      EXPECT_NEAR(unit.dot(mass * unit), 1060.0 * kSize.prod(), 1e-13 * 1060.0 * kSize.prod());
      const Eigen::VectorXd other =
          nodal(mesh, [i](const Eigen::Vector3d&) { return Eigen::Vector3d::Unit((i + 1) % 3).eval(); });
      EXPECT_EQ(unit.dot(mass * other), 0.0);
    }
  }
}

// int over the box of x^i y^j z^k.
double moment(int i, int j, int k) {
  return std::pow(kSize.x(), i + 1) / (i + 1) * std::pow(kSize.y(), j + 1) / (j + 1) * std::pow(kSize.z(), k + 1) / (k + 1);
}

TEST(Mass, IsExactForQuadraticFields) {
  const TetMesh mesh = distorted_box(kSize, 3, 2);
  const Discretisation fem(mesh);
  const SparseMatrix mass = fem.mass(Eigen::VectorXd::Ones(fem.element_count()));
  const std::vector<std::array<int, 3>> powers{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {2, 0, 0}, {0, 2, 0}, {1, 1, 0}, {0, 1, 1}};
  const auto field = [&mesh](const std::array<int, 3>& p) {
    return nodal(mesh, [&p](const Eigen::Vector3d& x) -> Eigen::Vector3d {
      return {std::pow(x.x(), p[0]) * std::pow(x.y(), p[1]) * std::pow(x.z(), p[2]), 0.0, 0.0};
    });
  };
  for (const auto& a : powers) {
    for (const auto& b : powers) {
      const double exact = moment(a[0] + b[0], a[1] + b[1], a[2] + b[2]);
      EXPECT_NEAR(field(a).dot(mass * field(b)), exact, 1e-12 * exact);
    }
  }
}

TEST(Mass, WeightsPickElements) {
  const TetMesh mesh = make_box_mesh(kSize, 2, 2, 2, 2);
  const Discretisation fem(mesh);
  Eigen::VectorXd weight = Eigen::VectorXd::Zero(fem.element_count());
  double volume = 0.0;
  for (int e = 0; e < fem.element_count(); e += 3) {
    weight[e] = 2.0;
    for (int q = 0; q < fem.points_per_element(); ++q) volume += 2.0 * fem.weight(e, q);
  }
  const Eigen::VectorXd unit = nodal(mesh, [](const Eigen::Vector3d&) { return Eigen::Vector3d::UnitX().eval(); });
  EXPECT_NEAR(unit.dot(fem.mass(weight) * unit), volume, 1e-13 * volume);
}

TEST(Discretisation, NamesAnInvertedElement) {
  TetMesh mesh = make_box_mesh(kSize, 1, 1, 1, 1);
  std::swap(mesh.tets(0, 2), mesh.tets(1, 2));
  try {
    const Discretisation fem(mesh);
    FAIL() << "an inverted element went through";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("tetrahedron 2"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace tissue_stiffness
