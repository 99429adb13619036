#include "effects/pressed_surface.hpp"

#include <Eigen/Geometry>

#include "effects/registry.hpp"
#include "types/cross_matrix.hpp"

namespace tissue_stiffness::effects {
PressedSurface::PressedSurface(const Value& region, const EffectContext& context)
    : mesh_(context.mesh),
      fem_(context.fem),
      facets_(find_surface(region, context.regions).facets),
      rule_(static_cast<int>(context.mesh.facets.rows())) {
  for (const int f : facets_) local_.push_back(facet_local_nodes(mesh_, f));
}

void PressedSurface::add_force(const Eigen::VectorXd* u, double pressure, Eigen::VectorXd& force) const {
  for (const int f : facets_) {
    const FacetNodes x = facet_nodes(mesh_, f, u);
    for (int q = 0; q < rule_.points(); ++q) {
      const Eigen::Vector3d load = -pressure * rule_.weight(q) * rule_.normal(x, q);
      for (Eigen::Index a = 0; a < x.cols(); ++a) force.segment<3>(3 * mesh_.facets(a, f)) += rule_.shape(q)[a] * load;
    }
  }
}

void PressedSurface::add_stiffness(const Eigen::VectorXd& u, double pressure, SparseMatrix& stiffness) const {
  for (std::size_t i = 0; i < facets_.size(); ++i) add_facet_stiffness(i, u, pressure, stiffness);
}

Eigen::VectorXd PressedSurface::unit_force() const {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(fem_.dof_count());
  add_force(nullptr, 1.0, out);
  return out;
}

void PressedSurface::add_facet_stiffness(std::size_t i, const Eigen::VectorXd& u, double pressure,
                                         SparseMatrix& stiffness) const {
  const int f = facets_[i];
  const FacetNodes x = facet_nodes(mesh_, f, &u);
  const Eigen::Index n = x.cols();
  Eigen::MatrixXd block = Eigen::MatrixXd::Zero(3 * n, 3 * n);
  for (int q = 0; q < rule_.points(); ++q) {
    const Eigen::MatrixX2d& d = rule_.derivative(q);
    const Eigen::Matrix<double, 3, 2> t = x * d;
    const Eigen::Matrix3d c0 = cross_matrix(t.col(0)), c1 = cross_matrix(t.col(1));
    for (Eigen::Index b = 0; b < n; ++b) {
      const Eigen::Matrix3d turn = pressure * rule_.weight(q) * (d(b, 1) * c0 - d(b, 0) * c1);
      for (Eigen::Index a = 0; a < n; ++a) block.block<3, 3>(3 * a, 3 * b) += rule_.shape(q)[a] * turn;
    }
  }
  block = (0.5 * (block + block.transpose())).eval();
  for (Eigen::Index b = 0; b < n; ++b) {
    for (Eigen::Index a = 0; a < n; ++a) {
      fem_.add_block(stiffness, mesh_.facet_tet[f], local_[i][static_cast<std::size_t>(a)],
                     local_[i][static_cast<std::size_t>(b)], block.block<3, 3>(3 * a, 3 * b));
    }
  }
}

}  // namespace tissue_stiffness::effects
