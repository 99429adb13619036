#include "fem/strain.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "fem/products.hpp"

namespace tissue_stiffness {
namespace {

const double kRoot = std::sqrt(2.0);

// Adds B_a u_a.
template <typename Row, typename Rows>
void add_strain(const Eigen::Vector3d& g, const Row& x, const Row& y, const Row& z, Eigen::Index at, Rows& e) {
  e.row(at) += g.x() * x;
  e.row(at + 1) += g.y() * y;
  e.row(at + 2) += g.z() * z;
  e.row(at + 3) += (g.y() * x + g.x() * y) / kRoot;
  e.row(at + 4) += (g.z() * y + g.y() * z) / kRoot;
  e.row(at + 5) += (g.z() * x + g.x() * z) / kRoot;
}

// Calls set(e, q, out) for all quadrature points.
template <typename Set>
void for_each_point(const Discretisation& fem, const Set& set, Eigen::Ref<Eigen::VectorXd> out) {
  const int points = fem.points_per_element();
  tbb::parallel_for(0, fem.element_count(), [&](int e) {
    for (int q = 0; q < points; ++q) out.segment<6>(6 * (static_cast<Eigen::Index>(e) * points + q)) = set(e, q);
  });
}

Eigen::Matrix3d gradient_of(const Discretisation& fem, const Eigen::VectorXd& u, int e, int q) {
  const auto g = fem.gradient(e, q);
  Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
  for (int a = 0; a < fem.nodes_per_element(); ++a) {
    h.noalias() += u.segment<3>(3 * fem.elements()(a, e)) * g.col(a).transpose();
  }
  return h;
}

}  // namespace

Strain to_strain(const Eigen::Matrix3d& t) {
  Strain s;
  s << t.diagonal(), (t(0, 1) + t(1, 0)) / kRoot, (t(1, 2) + t(2, 1)) / kRoot, (t(0, 2) + t(2, 0)) / kRoot;
  return s;
}

Eigen::Matrix3d to_tensor(const Strain& s) {
  const double xy = s[3] / kRoot, yz = s[4] / kRoot, xz = s[5] / kRoot;
  Eigen::Matrix3d t;
  t << s[0], xy, xz, xy, s[1], yz, xz, yz, s[2];
  return t;
}

void green_strains(const Discretisation& fem, const Eigen::VectorXd& u, Eigen::Ref<Eigen::VectorXd> strains) {
  const auto strain = [&](int e, int q) {
    const Eigen::Matrix3d h = gradient_of(fem, u, e, q);
    return to_strain(0.5 * (h + h.transpose() + h.transpose() * h));
  };
  for_each_point(fem, strain, strains);
}

void green_strain_rates(const Discretisation& fem, const Eigen::VectorXd& u, const Eigen::VectorXd& v,
                        Eigen::Ref<Eigen::VectorXd> rates) {
  const auto rate = [&](int e, int q) {
    const Eigen::Matrix3d f = Eigen::Matrix3d::Identity() + gradient_of(fem, u, e, q);
    const Eigen::Matrix3d half = f.transpose() * gradient_of(fem, v, e, q);
    return to_strain(0.5 * (half + half.transpose()));
  };
  for_each_point(fem, rate, rates);
}

Strain strain_of(const Eigen::Vector3d& d) {
  Strain s;
  s << d.x() * d.x(), d.y() * d.y(), d.z() * d.z(), kRoot * d.x() * d.y(), kRoot * d.y() * d.z(), kRoot * d.x() * d.z();
  return s;
}

StrainFactor isotropic_factor(double lambda, double mu) {
  // The eigenvalue is 3 lambda + 2 mu on the span of m, and 2 mu elsewhere.
  const double bulk = std::sqrt(3.0 * lambda + 2.0 * mu), shear = std::sqrt(2.0 * mu);
  StrainFactor r = shear * StrainFactor::Identity(6, 6);
  r.topLeftCorner<3, 3>().array() += (bulk - shear) / 3.0;
  return r;
}

StrainRows strains(const Discretisation& fem, const Eigen::MatrixXd& u) {
  const int points = fem.points_per_element();
  StrainRows result = StrainRows::Zero(static_cast<Eigen::Index>(6) * points * fem.element_count(), u.cols());
  const StrainRows rows = u;
  tbb::parallel_for(0, fem.element_count(), [&](int e) {
    for (int q = 0; q < points; ++q) {
      const auto g = fem.gradient(e, q);
      const Eigen::Index at = 6 * (static_cast<Eigen::Index>(e) * points + q);
      for (int a = 0; a < fem.nodes_per_element(); ++a) {
        const Eigen::Index node = 3 * fem.elements()(a, e);
        add_strain(g.col(a), rows.row(node), rows.row(node + 1), rows.row(node + 2), at, result);
      }
    }
  });
  return result;
}

Strain strain_at(const Discretisation& fem, const Eigen::VectorXd& u, int e, int q) {
  const Eigen::Matrix3d h = gradient_of(fem, u, e, q);
  return to_strain(0.5 * (h + h.transpose()));
}

void add_strain_stiffness(const Discretisation& fem, const StrainFactorField& factor, double scale, SparseMatrix& k) {
  const int n = fem.nodes_per_element();
  Eigen::Matrix<double, 3, Eigen::Dynamic> forces(3, 6 * n);
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const StrainFactor r = factor(e, q);
      const auto g = fem.gradient(e, q);
      const Eigen::Index columns = r.cols();
      for (Eigen::Index c = 0; c < columns; ++c) {
        const Eigen::Matrix3d stress = to_tensor(r.col(c));
        for (int a = 0; a < n; ++a) forces.col(6 * a + c) = stress * g.col(a);
      }
      const double w = scale * fem.weight(e, q);
      for (int b = 0; columns > 0 && b < n; ++b) {
        for (int a = 0; a < n; ++a) {
          const Eigen::Matrix3d block =
              w * forces.middleCols(6 * a, columns) * forces.middleCols(6 * b, columns).transpose();
          fem.add_block(k, e, a, b, block);
        }
      }
    }
  }
}

Eigen::MatrixXd apply_strain_stiffness(const Discretisation& fem, const StrainFactorField& factor,
                                       const StrainRows& strains) {
  const int n = fem.nodes_per_element(), points = fem.points_per_element();
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(fem.dof_count(), strains.cols());
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < points; ++q) {
      const StrainFactor r = factor(e, q);
      if (r.cols() == 0) continue;
      const Eigen::Index at = 6 * (static_cast<Eigen::Index>(e) * points + q);
      const Eigen::MatrixXd stress = fem.weight(e, q) * (r * (r.transpose() * strains.middleRows<6>(at)));
      const auto g = fem.gradient(e, q);
      for (Eigen::Index c = 0; c < stress.cols(); ++c) {
        const Eigen::Matrix3d of = to_tensor(stress.col(c));
        for (int a = 0; a < n; ++a) result.block<3, 1>(3 * fem.elements()(a, e), c) += of * g.col(a);
      }
    }
  }
  return result;
}

Eigen::MatrixXd project_strain_stiffness(const Discretisation& fem, const StrainFactorField& factor,
                                         const StrainRows& strains) {
  constexpr Eigen::Index block = 1024;  // rows that are gathered before they are multiplied
  const int points = fem.points_per_element();
  const Eigen::Index m = strains.cols();
  GramSum result(m);
  StrainRows rows(block + 6, m);
  Eigen::Index count = 0;
  const auto flush = [&] {
    result.add(rows, count);
    count = 0;
  };
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < points; ++q) {
      const StrainFactor r = factor(e, q);
      if (r.cols() == 0) continue;
      const Eigen::Index at = 6 * (static_cast<Eigen::Index>(e) * points + q);
      rows.middleRows(count, r.cols()).noalias() =
          (std::sqrt(fem.weight(e, q)) * r.transpose()) * strains.middleRows<6>(at);
      count += r.cols();
      if (count >= block) flush();
    }
  }
  flush();
  return result.sum();
}

void add_stress_force(const Discretisation& fem, const StressField& stress, Eigen::VectorXd& force) {
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const Eigen::Matrix3d s = to_tensor(fem.weight(e, q) * stress(e, q));
      const auto g = fem.gradient(e, q);
      for (int a = 0; a < fem.nodes_per_element(); ++a) force.segment<3>(3 * fem.elements()(a, e)) -= s * g.col(a);
    }
  }
}

}  // namespace tissue_stiffness
