#include "fem/neo_hookean.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <cmath>
#include <string>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kElements = 64, kNodes = 512;  // worth a task

template <int N>
using Nodal = Eigen::Matrix<double, 3, N>;

template <int N>
Nodal<N> gather(const Eigen::MatrixXi& elements, int e, const Eigen::VectorXd& u) {
  Nodal<N> local;
  for (int a = 0; a < N; ++a) local.col(a) = u.segment<3>(3 * elements(a, e));
  return local;
}

// F, its inverse and ln J at one quadrature point.
struct Deformation {
  Eigen::Matrix3d gradient;
  Eigen::Matrix3d inverse;
  double log_volume;
};

template <int N>
Deformation deform(const Nodal<N>& u, const Eigen::Map<const Nodal<N>>& g, int e) {
  Deformation d;
  d.gradient.noalias() = u * g.transpose();
  d.gradient.diagonal().array() += 1.0;
  const double volume = d.gradient.determinant();
  if (!(volume > 0.0)) throw NumericalError("tetrahedron " + std::to_string(e) + " turned inside out");
  d.inverse = d.gradient.inverse();
  d.log_volume = std::log(volume);
  return d;
}

double energy_density(const Lame& c, const Deformation& d) {
  return 0.5 * c.mu * (d.gradient.squaredNorm() - 3.0 - 2.0 * d.log_volume) + 0.5 * c.lambda * d.log_volume * d.log_volume;
}

// Returns the first Piola-Kirchhoff stress.
Eigen::Matrix3d stress(const Lame& c, const Deformation& d) {
  return c.mu * d.gradient + (c.lambda * d.log_volume - c.mu) * d.inverse.transpose();
}

struct Plain {
  StressScale operator()(int, int, double) const { return {}; }
};

template <int N, typename Law>
void stiffness(const Discretisation& fem, const std::vector<int>& list, const Lame& c, const Eigen::VectorXd& u,
               const Law& law, SparseMatrix& k) {
  for (const int e : list) {
    const Nodal<N> local = gather<N>(fem.elements(), e, u);
    Eigen::Matrix<double, 3 * N, 3 * N> block = Eigen::Matrix<double, 3 * N, 3 * N>::Zero();
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const Eigen::Map<const Nodal<N>> g(fem.gradient(e, q).data());
      const Deformation d = deform<N>(local, g, e);
      const StressScale scale = law(e, q, energy_density(c, d));
      if (scale.value == 0.0 && scale.slope == 0.0) continue;
      const Nodal<N> h = d.inverse.transpose() * g;  // gradients in the deformed body
      const Nodal<N> p = stress(c, d) * g;
      const double w = scale.value * fem.weight(e, q), s = w * (c.mu - c.lambda * d.log_volume), l = w * c.lambda,
                   m = w * c.mu, steeper = scale.slope * fem.weight(e, q);
      for (int b = 0; b < N; ++b) {
        for (int a = 0; a < N; ++a) {
          auto part = block.template block<3, 3>(3 * a, 3 * b);
          part.noalias() += (s * h.col(b)) * h.col(a).transpose() + (l * h.col(a)) * h.col(b).transpose();
          part.diagonal().array() += m * g.col(a).dot(g.col(b));
          if (steeper != 0.0) part.noalias() += (steeper * p.col(a)) * p.col(b).transpose();
        }
      }
    }
    for (int b = 0; b < N; ++b) {
      for (int a = 0; a < N; ++a) fem.add_block(k, e, a, b, block.template block<3, 3>(3 * a, 3 * b));
    }
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

NeoHookean::NeoHookean(const Discretisation& fem, std::vector<int> elements)
    : fem_(fem),
      elements_(std::move(elements)),
      corners_(fem.elements(), elements_, fem.node_count()),
      scratch_(std::make_unique<VectorPool>()) {}

// Processes elements in parallel, and then nodes. Each node sums its parts in a fixed order, whatever the threads do.
template <int N, typename Law>
void NeoHookean::force(const Lame& c, const Eigen::VectorXd& u, const Law& law, Eigen::VectorXd& f) const {
  VectorPool::Loan shares(*scratch_, 3 * static_cast<Eigen::Index>(corners_.corners.size()));
  const auto count = static_cast<int>(elements_.size());
  tbb::parallel_for(tbb::blocked_range<int>(0, count, kElements), [&](const tbb::blocked_range<int>& part) {
    for (int i = part.begin(); i < part.end(); ++i) {
      const int e = elements_[static_cast<std::size_t>(i)];
      const Nodal<N> local = gather<N>(fem_.elements(), e, u);
      Nodal<N> internal = Nodal<N>::Zero();
      for (int q = 0; q < fem_.points_per_element(); ++q) {
        const Eigen::Map<const Nodal<N>> g(fem_.gradient(e, q).data());
        const Deformation d = deform<N>(local, g, e);
        const double scale = law(e, q, energy_density(c, d)).value;
        if (scale != 0.0) internal.noalias() += (scale * fem_.weight(e, q) * stress(c, d)) * g;
      }
      Eigen::Map<Nodal<N>>(shares->data() + static_cast<std::ptrdiff_t>(3 * N) * i) = internal;
    }
  });
  tbb::parallel_for(tbb::blocked_range<int>(0, fem_.node_count(), kNodes), [&](const tbb::blocked_range<int>& part) {
    for (int node = part.begin(); node < part.end(); ++node) {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      const auto at = static_cast<std::size_t>(node);
      for (int k = corners_.first[at]; k < corners_.first[at + 1]; ++k) {
        sum += shares->segment<3>(3 * static_cast<Eigen::Index>(corners_.corners[static_cast<std::size_t>(k)]));
      }
      f.segment<3>(3 * node) -= sum;
    }
  });
}

void NeoHookean::add_force(const Lame& lame, const Eigen::VectorXd& u, Eigen::VectorXd& f) const {
  fem_.nodes_per_element() == 10 ? force<10>(lame, u, Plain(), f) : force<4>(lame, u, Plain(), f);
}

void NeoHookean::add_stiffness(const Lame& lame, const Eigen::VectorXd& u, SparseMatrix& k) const {
  fem_.nodes_per_element() == 10 ? stiffness<10>(fem_, elements_, lame, u, Plain(), k)
                                 : stiffness<4>(fem_, elements_, lame, u, Plain(), k);
}

void NeoHookean::add_force(const Lame& lame, const Eigen::VectorXd& u, const PointLaw& scale, Eigen::VectorXd& f) const {
  fem_.nodes_per_element() == 10 ? force<10>(lame, u, scale, f) : force<4>(lame, u, scale, f);
}

void NeoHookean::add_stiffness(const Lame& lame, const Eigen::VectorXd& u, const PointLaw& scale, SparseMatrix& k) const {
  fem_.nodes_per_element() == 10 ? stiffness<10>(fem_, elements_, lame, u, scale, k)
                                 : stiffness<4>(fem_, elements_, lame, u, scale, k);
}

double NeoHookean::energy(const Lame& lame, const Eigen::VectorXd& u) const {
  return fem_.nodes_per_element() == 10 ? stored<10>(fem_, elements_, lame, u) : stored<4>(fem_, elements_, lame, u);
}

}  // namespace tissue_stiffness
