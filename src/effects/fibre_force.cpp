#include "effects/fibre_field.hpp"

namespace tissue_stiffness {
namespace {

// Values at one quadrature point: the stretched direction F a and the slope of each shape function along a.
struct Stretched {
  Eigen::Vector3d direction;
  Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 10, 1> slope;
  FibreTension tension;
};

Stretched stretch(const Discretisation& fem, int e, int q, const Eigen::Vector3d& a, const FibreLaw& law,
                  const Eigen::VectorXd& u) {
  Stretched s{a, fem.gradient(e, q).transpose() * a, {}};
  for (int k = 0; k < fem.nodes_per_element(); ++k) s.direction += s.slope[k] * u.segment<3>(3 * fem.elements()(k, e));
  s.tension = law(0.5 * (s.direction.squaredNorm() - 1.0));
  return s;
}

}  // namespace

void add_fibre_force(const Discretisation& fem, const FibreDirections& directions, const FibreLaw& law,
                     const Eigen::VectorXd& u, Eigen::VectorXd& force) {
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const Stretched s = stretch(fem, e, q, directions(e, q), law, u);
      const Eigen::Vector3d pull = fem.weight(e, q) * s.tension.value * s.direction;
      for (int a = 0; a < fem.nodes_per_element(); ++a) force.segment<3>(3 * fem.elements()(a, e)) -= s.slope[a] * pull;
    }
  }
}

void add_fibre_stiffness(const Discretisation& fem, const FibreDirections& directions, const FibreLaw& law,
                         const Eigen::VectorXd& u, SparseMatrix& stiffness) {
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const Stretched s = stretch(fem, e, q, directions(e, q), law, u);
      const Eigen::Matrix3d block = fem.weight(e, q) * (s.tension.slope * s.direction * s.direction.transpose() +
                                                        s.tension.value * Eigen::Matrix3d::Identity());
      for (int b = 0; b < fem.nodes_per_element(); ++b) {
        for (int a = 0; a < fem.nodes_per_element(); ++a) {
          fem.add_block(stiffness, e, a, b, s.slope[a] * s.slope[b] * block);
        }
      }
    }
  }
}

}  // namespace tissue_stiffness
