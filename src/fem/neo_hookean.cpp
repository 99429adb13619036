#include "fem/neo_hookean.hpp"

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "fem/element_forces.hpp"
#include "fem/strain.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// F, its inverse and ln J at one quadrature point.
struct Deformation {
  Eigen::Matrix3d gradient;
  Eigen::Matrix3d inverse;
  double log_volume;
};

// Returns false where the material is turned inside out.
bool invert(Deformation& d) {
  const double volume = d.gradient.determinant();
  if (!(volume > 0.0)) return false;
  d.inverse = d.gradient.inverse();
  d.log_volume = std::log(volume);
  return true;
}

template <int N>
Deformation deform(const Nodal<N>& u, const Eigen::Map<const Nodal<N>>& g, int e) {
  Deformation d;
  d.gradient.noalias() = u * g.transpose();
  d.gradient.diagonal().array() += 1.0;
  if (!invert(d)) throw NumericalError("tetrahedron " + std::to_string(e) + " turned inside out");
  return d;
}

Deformation deform_point(const Eigen::Matrix3d& f) {
  Deformation d;
  d.gradient = f;
  if (!invert(d)) throw NumericalError("a sampled point turned inside out");
  return d;
}

// Calls entry(i, j, k, l) for the derivative of component i j of the stress with respect to component k l.
template <typename Entry>
StressTangent stress_tangent(const Entry& entry) {
  StressTangent a;
  for (int l = 0; l < 3; ++l) {
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < 3; ++j) {
        for (int i = 0; i < 3; ++i) a(i + 3 * j, k + 3 * l) = entry(i, j, k, l);
      }
    }
  }
  return a;
}

double energy_density(const Lame& c, const Deformation& d) {
  return 0.5 * c.mu * (d.gradient.squaredNorm() - 3.0 - 2.0 * d.log_volume) + 0.5 * c.lambda * d.log_volume * d.log_volume;
}

// Returns the first Piola-Kirchhoff stress.
Eigen::Matrix3d stress(const Lame& c, const Deformation& d) {
  return c.mu * d.gradient + (c.lambda * d.log_volume - c.mu) * d.inverse.transpose();
}

template <int N>
void add_blocks(const Discretisation& fem, int e, const Eigen::Matrix<double, 3 * N, 3 * N>& block, SparseMatrix& k) {
  for (int b = 0; b < N; ++b) {
    for (int a = 0; a < N; ++a) fem.add_block(k, e, a, b, block.template block<3, 3>(3 * a, 3 * b));
  }
}

template <int N>
void stiffness(const Discretisation& fem, const std::vector<int>& list, const Lame& c, const Eigen::VectorXd& u,
               SparseMatrix& k) {
  for (const int e : list) {
    const Nodal<N> local = gather<N>(fem.elements(), e, u);
    Eigen::Matrix<double, 3 * N, 3 * N> block = Eigen::Matrix<double, 3 * N, 3 * N>::Zero();
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const Eigen::Map<const Nodal<N>> g(fem.gradient(e, q).data());
      const Deformation d = deform<N>(local, g, e);
      const Nodal<N> h = d.inverse.transpose() * g;  // gradients in the deformed body
      const double w = fem.weight(e, q), s = w * (c.mu - c.lambda * d.log_volume), l = w * c.lambda, m = w * c.mu;
      for (int b = 0; b < N; ++b) {
        for (int a = 0; a < N; ++a) {
          auto part = block.template block<3, 3>(3 * a, 3 * b);
          part.noalias() += (s * h.col(b)) * h.col(a).transpose() + (l * h.col(a)) * h.col(b).transpose();
          part.diagonal().array() += m * g.col(a).dot(g.col(b));
        }
      }
    }
    add_blocks<N>(fem, e, block, k);
  }
}

// Adds w F S(dE) g with dE = sym(F^T dw g^T), h = F g.
template <int N>
void strain_tangent(const Discretisation& fem, const std::vector<int>& list, const Lame& c, const Eigen::VectorXd& u,
                    const PointShare& share, SparseMatrix& k) {
  for (const int e : list) {
    const Nodal<N> local = gather<N>(fem.elements(), e, u);
    Eigen::Matrix<double, 3 * N, 3 * N> block = Eigen::Matrix<double, 3 * N, 3 * N>::Zero();
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const double w = share(e, q) * fem.weight(e, q);
      if (w == 0.0) continue;
      const Eigen::Map<const Nodal<N>> g(fem.gradient(e, q).data());
      const Eigen::Matrix3d f = Eigen::Matrix3d::Identity() + local * g.transpose(), ff = f * f.transpose();
      const Nodal<N> h = f * g;
      for (int b = 0; b < N; ++b) {
        for (int a = 0; a < N; ++a) {
          auto part = block.template block<3, 3>(3 * a, 3 * b);
          part.noalias() += (w * c.lambda * h.col(a)) * h.col(b).transpose() + (w * c.mu * h.col(b)) * h.col(a).transpose();
          part.noalias() += (w * c.mu * g.col(a).dot(g.col(b))) * ff;
        }
      }
    }
    add_blocks<N>(fem, e, block, k);
  }
}

template <int N>
double stored(const Discretisation& fem, const std::vector<int>& list, const Lame& c, const Eigen::VectorXd& u) {
  double energy = 0.0;
  for (const int e : list) {
    const Nodal<N> local = gather<N>(fem.elements(), e, u);
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const Deformation d = deform<N>(local, Eigen::Map<const Nodal<N>>(fem.gradient(e, q).data()), e);
      energy += fem.weight(e, q) * energy_density(c, d);
    }
  }
  return energy;
}

}  // namespace

double neo_hookean_energy(const Lame& c, const Eigen::Matrix3d& f) {
  return energy_density(c, deform_point(f));
}

Eigen::Matrix3d neo_hookean_stress(const Lame& c, const Eigen::Matrix3d& f) {
  return stress(c, deform_point(f));
}

StressTangent neo_hookean_tangent(const Lame& c, const Eigen::Matrix3d& f) {
  const Deformation d = deform_point(f);
  const Eigen::Matrix3d& h = d.inverse;
  const double s = c.mu - c.lambda * d.log_volume;
  StressTangent a =
      stress_tangent([&](int i, int j, int k, int l) { return s * h(j, k) * h(l, i) + c.lambda * h(j, i) * h(l, k); });
  a.diagonal().array() += c.mu;
  return a;
}

Eigen::Matrix3d viscous_stress(const Lame& c, const Eigen::Matrix3d& f, const Eigen::Matrix3d& rate) {
  const Eigen::Matrix3d half = f.transpose() * rate;
  Eigen::Matrix3d second = c.mu * (half + half.transpose());
  second.diagonal().array() += c.lambda * half.trace();
  return f * second;
}

StressTangent viscous_tangent(const Lame& c, const Eigen::Matrix3d& f) {
  const Eigen::Matrix3d left = f * f.transpose();
  return stress_tangent([&](int i, int j, int k, int l) {
    return c.lambda * f(i, j) * f(k, l) + c.mu * (f(i, l) * f(k, j) + (j == l ? left(i, k) : 0.0));
  });
}

NeoHookean::NeoHookean(const Discretisation& fem, std::vector<int> elements)
    : fem_(fem),
      elements_(std::move(elements)),
      corners_(fem.elements(), elements_, fem.node_count()),
      scratch_(std::make_unique<VectorPool>()) {}

template <int N>
void NeoHookean::force(const Lame& c, const Eigen::VectorXd& u, Eigen::VectorXd& f) const {
  const auto internal = [&](int e) {
    const Nodal<N> local = gather<N>(fem_.elements(), e, u);
    Nodal<N> out = Nodal<N>::Zero();
    for (int q = 0; q < fem_.points_per_element(); ++q) {
      const Eigen::Map<const Nodal<N>> g(fem_.gradient(e, q).data());
      const Deformation d = deform<N>(local, g, e);
      out.noalias() += (fem_.weight(e, q) * stress(c, d)) * g;
    }
    return out;
  };
  subtract_element_forces<N>(elements_, corners_, fem_.node_count(), *scratch_, internal, f);
}

void NeoHookean::add_force(const Lame& lame, const Eigen::VectorXd& u, Eigen::VectorXd& f) const {
  fem_.nodes_per_element() == 10 ? force<10>(lame, u, f) : force<4>(lame, u, f);
}

void NeoHookean::add_stiffness(const Lame& lame, const Eigen::VectorXd& u, SparseMatrix& k) const {
  fem_.nodes_per_element() == 10 ? stiffness<10>(fem_, elements_, lame, u, k) : stiffness<4>(fem_, elements_, lame, u, k);
}

template <int N>
void NeoHookean::strain_force(const Lame& c, const Eigen::VectorXd& u, const Eigen::Ref<const Eigen::VectorXd>& strains,
                              const PointShare& share, Eigen::VectorXd& f) const {
  const int points = fem_.points_per_element();
  const auto internal = [&](int e) {
    const Nodal<N> local = gather<N>(fem_.elements(), e, u);
    Nodal<N> out = Nodal<N>::Zero();
    for (int q = 0; q < points; ++q) {
      const double w = share(e, q) * fem_.weight(e, q);
      if (w == 0.0) continue;
      const Eigen::Map<const Nodal<N>> g(fem_.gradient(e, q).data());
      const Strain strain = strains.template segment<6>(6 * (static_cast<Eigen::Index>(e) * points + q));
      Eigen::Matrix3d second = 2.0 * c.mu * to_tensor(strain);
      second.diagonal().array() += c.lambda * strain.head<3>().sum();
      out.noalias() += (w * (Eigen::Matrix3d::Identity() + local * g.transpose()) * second) * g;
    }
    return out;
  };
  subtract_element_forces<N>(elements_, corners_, fem_.node_count(), *scratch_, internal, f);
}

void NeoHookean::add_strain_force(const Lame& lame, const Eigen::VectorXd& u,
                                  const Eigen::Ref<const Eigen::VectorXd>& strains, const PointShare& share,
                                  Eigen::VectorXd& f) const {
  fem_.nodes_per_element() == 10 ? strain_force<10>(lame, u, strains, share, f)
                                 : strain_force<4>(lame, u, strains, share, f);
}

void NeoHookean::add_strain_tangent(const Lame& lame, const Eigen::VectorXd& u, const PointShare& share,
                                    SparseMatrix& k) const {
  fem_.nodes_per_element() == 10 ? strain_tangent<10>(fem_, elements_, lame, u, share, k)
                                 : strain_tangent<4>(fem_, elements_, lame, u, share, k);
}

double NeoHookean::energy(const Lame& lame, const Eigen::VectorXd& u) const {
  return fem_.nodes_per_element() == 10 ? stored<10>(fem_, elements_, lame, u) : stored<4>(fem_, elements_, lame, u);
}

}  // namespace tissue_stiffness
