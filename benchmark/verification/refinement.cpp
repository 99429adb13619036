// Order of convergence under mesh refinement, against a manufactured solution.
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "elastic_body.hpp"
#include "figures.hpp"

namespace tissue_stiffness {
namespace {

const Lame kLame = lame(1.0, 0.3);
constexpr double kWave = 2.0;  // of the manufactured solution on the unit cube

// u = (sin kx cos ky, cos ky sin kz, sin kx sin kz)
Eigen::Vector3d exact(const Eigen::Vector3d& p) {
  const double x = kWave * p.x(), y = kWave * p.y(), z = kWave * p.z();
  return {std::sin(x) * std::cos(y), std::cos(y) * std::sin(z), std::sin(x) * std::sin(z)};
}

// Row i: gradient of component i.
Eigen::Matrix3d exact_gradient(const Eigen::Vector3d& p) {
  const double x = kWave * p.x(), y = kWave * p.y(), z = kWave * p.z();
  Eigen::Matrix3d g;
  g << std::cos(x) * std::cos(y), -std::sin(x) * std::sin(y), 0.0,  //
      0.0, -std::sin(y) * std::sin(z), std::cos(y) * std::cos(z),   //
      std::cos(x) * std::sin(z), 0.0, std::sin(x) * std::cos(z);
  return kWave * g;
}

// -div sigma = -(lambda + mu) grad div u - mu laplace u
Eigen::Vector3d body_force(const Eigen::Vector3d& p) {
  const double x = kWave * p.x(), y = kWave * p.y(), z = kWave * p.z(), k2 = kWave * kWave;
  // div u = k (cos x cos y - sin y sin z + sin x cos z)
  const Eigen::Vector3d grad_div = k2 * Eigen::Vector3d(-std::sin(x) * std::cos(y) + std::cos(x) * std::cos(z),
                                                        -std::cos(x) * std::sin(y) - std::cos(y) * std::sin(z),
                                                        -std::sin(y) * std::cos(z) - std::sin(x) * std::sin(z));
  return -(kLame.lambda + kLame.mu) * grad_div + 2.0 * k2 * kLame.mu * exact(p);
}

// Gauss-Legendre points of three variables folded into the unit tetrahedron (Duffy), degree 5.
std::vector<std::pair<Eigen::Vector3d, double>> fine_rule() {
  const std::array<double, 4> at{0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263};
  const std::array<double, 4> weight{0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
  std::vector<std::pair<Eigen::Vector3d, double>> rule;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      for (std::size_t k = 0; k < 4; ++k) {
        const double r = at[i], s = (1.0 - r) * at[j], t = (1.0 - r - s) * at[k];
        rule.push_back({{r, s, t}, weight[i] * weight[j] * weight[k] * (1.0 - r) * (1.0 - r - s)});
      }
    }
  }
  return rule;
}

struct Errors {
  double displacement = 0.0;  ///< L2 norm
  double energy = 0.0;        ///< square root of twice the elastic energy of the error
};

double energy_density(const Eigen::Matrix3d& gradient) {
  const Eigen::Matrix3d strain = 0.5 * (gradient + gradient.transpose());
  return kLame.lambda * strain.trace() * strain.trace() + 2.0 * kLame.mu * strain.squaredNorm();
}

Errors errors(const TetMesh& mesh, const Eigen::VectorXd& u) {
  const auto rule = fine_rule();
  const int n = static_cast<int>(mesh.tets.rows());
  Errors sum;
  for (Eigen::Index e = 0; e < mesh.tets.cols(); ++e) {
    Eigen::Matrix3Xd x(3, n), d(3, n);
    for (Eigen::Index a = 0; a < n; ++a) {
      x.col(a) = mesh.nodes.col(mesh.tets(a, e));
      d.col(a) = u.segment<3>(3 * mesh.tets(a, e));
    }
    for (const auto& [place, weight] : rule) {
      const Eigen::VectorXd shape = tet_shape(n, place);
      const Eigen::MatrixXd derivative = tet_shape_derivative(n, place);
      const Eigen::Matrix3d jacobian = derivative * x.transpose();
      const double volume = weight * jacobian.determinant();
      const Eigen::Matrix3d gradient = d * (jacobian.inverse() * derivative).transpose();
      sum.displacement += volume * (d * shape - exact(x * shape)).squaredNorm();
      sum.energy += volume * energy_density(gradient - exact_gradient(x * shape));
    }
  }
  return {std::sqrt(sum.displacement), std::sqrt(sum.energy)};
}

Errors solve(int order, int cells) {
  const TetMesh mesh = make_box_mesh({1.0, 1.0, 1.0}, cells, cells, cells, order);
  ElasticBody body(mesh, ElasticBody::Law::linear, kLame, 1.0, boundary_dofs(mesh));
  body.set_load(body.mass() * nodal(mesh, body_force));
  const Eigen::VectorXd boundary = nodal(mesh, exact);
  return errors(mesh, equilibrium(body, boundary, Eigen::VectorXd::Zero(boundary.size()), 1));
}

}  // namespace

std::vector<Figure> refinement_figures() {
  std::vector<Figure> figures;
  for (const int order : {1, 2}) {
    const Errors coarse = solve(order, 6 / order), fine = solve(order, 12 / order);
    const std::string nodes = order == 1 ? "4 nodes" : "10 nodes";
    figures.push_back({"order in space, displacement in L2, " + nodes, std::log2(coarse.displacement / fine.displacement),
                       order + 0.85, order + 1.15});
    figures.push_back(
        {"order in space, energy norm, " + nodes, std::log2(coarse.energy / fine.energy), order - 0.15, order + 0.15});
  }
  return figures;
}

}  // namespace tissue_stiffness
