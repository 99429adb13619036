// Linear fields and rigid motions: what every element must get right to round-off.
#include <Eigen/Geometry>
#include <algorithm>

#include "elastic_body.hpp"
#include "figures.hpp"

namespace tissue_stiffness {
namespace {

using Law = ElasticBody::Law;

const Eigen::Vector3d kSize(0.10, 0.08, 0.06);
const Lame kLame = lame(20e3, 0.45);

// Largest error of the inner nodes, over the size of the field, when the boundary follows u = (F - 1) X.
double patch_error(int order, Law law, const Eigen::Matrix3d& stretch) {
  const TetMesh mesh = distorted_box(kSize, 3, order);
  const ElasticBody body(mesh, law, kLame, 1000.0, boundary_dofs(mesh));
  const Eigen::VectorXd exact =
      nodal(mesh, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d { return (stretch - Eigen::Matrix3d::Identity()) * x; });
  // Newton starts beside the solution: finding it is part of the test.
  const Eigen::VectorXd start = exact + random_vector(exact.size(), 1e-3, 3);
  return (equilibrium(body, exact, start) - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

// Force at displacement u over the largest product that its sums are made of.
double relative_force(const ElasticBody& body, const Eigen::VectorXd& u) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.size());
  const double scale = (body.stiffness(0.0, rest, rest).cwiseAbs() * u.cwiseAbs()).maxCoeff();
  return body.force(0.0, u, rest).cwiseAbs().maxCoeff() / scale;
}

double linear_rigid_force(int order) {
  const TetMesh mesh = distorted_box(kSize, 3, order);
  const ElasticBody body(mesh, Law::linear, kLame, 1000.0, boundary_dofs(mesh));
  const Eigen::VectorXd translation = nodal(mesh, [](const Eigen::Vector3d&) -> Eigen::Vector3d {
    return {0.3, -0.2, 0.7};
  });
  const Eigen::VectorXd rotation =
      nodal(mesh, [](const Eigen::Vector3d& x) -> Eigen::Vector3d { return Eigen::Vector3d(0.4, -0.9, 0.2).cross(x); });
  return std::max(relative_force(body, translation), relative_force(body, rotation));
}

// Force, or energy over mu V, whichever is larger, after a large rotation.
double finite_rigid_force(int order) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()).toRotationMatrix();
  const TetMesh mesh = distorted_box(kSize, 3, order);
  const ElasticBody body(mesh, Law::neo_hookean, kLame, 1000.0, boundary_dofs(mesh));
  const Eigen::VectorXd u = nodal(mesh, [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return (turn - Eigen::Matrix3d::Identity()) * x + Eigen::Vector3d(0.02, 0.05, -0.01);
  });
  const double energy = std::abs(body.energy(u, Eigen::VectorXd::Zero(u.size()))) / (kLame.mu * kSize.prod());
  return std::max(relative_force(body, u), energy);
}

}  // namespace

std::vector<Figure> patch_figures() {
  Eigen::Matrix3d small, large;
  small << 1.02, 0.03, -0.01, 0.005, 0.97, 0.02, -0.015, 0.01, 1.04;
  large << 1.6, 0.3, -0.1, 0.2, 0.75, 0.1, -0.2, 0.1, 1.1;
  std::vector<Figure> figures;
  for (const int order : {1, 2}) {
    const std::string nodes = order == 1 ? ", 4 nodes" : ", 10 nodes";
    figures.push_back({"patch test, linear" + nodes, patch_error(order, Law::linear, small), 0.0, 1e-12});
    figures.push_back({"patch test, neo-Hookean" + nodes, patch_error(order, Law::neo_hookean, small), 0.0, 1e-11});
    figures.push_back(
        {"patch test, neo-Hookean, stretch 1.6" + nodes, patch_error(order, Law::neo_hookean, large), 0.0, 1e-11});
    figures.push_back({"rigid motion, linear" + nodes, linear_rigid_force(order), 0.0, 1e-13});
    figures.push_back({"rigid motion, neo-Hookean, turned by 120 degrees" + nodes, finite_rigid_force(order), 0.0, 1e-13});
  }
  return figures;
}

}  // namespace tissue_stiffness
