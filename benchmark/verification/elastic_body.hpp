#pragma once

#include <Eigen/Core>
#include <functional>
#include <random>
#include <vector>

#include "fem/discretisation.hpp"
#include "fem/generalized_alpha.hpp"
#include "fem/neo_hookean.hpp"
#include "fem/products.hpp"
#include "meshing/box_mesh.hpp"
#include "meshing/elevate.hpp"

namespace tissue_stiffness {

/// Nodal values of a vector field, 3n.
inline Eigen::VectorXd nodal(const TetMesh& mesh, const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& field) {
  Eigen::VectorXd u(3 * mesh.node_count());
  for (int i = 0; i < mesh.node_count(); ++i) u.segment<3>(3 * i) = field(mesh.nodes.col(i));
  return u;
}

/// A flag for each degree of freedom of a boundary node.
inline std::vector<char> boundary_dofs(const TetMesh& mesh) {
  std::vector<char> flags(static_cast<std::size_t>(3 * mesh.node_count()), 0);
  for (Eigen::Index i = 0; i < mesh.facets.size(); ++i) std::fill_n(flags.begin() + 3 * mesh.facets(i), 3, char{1});
  return flags;
}

/// A flag for each degree of freedom of a node with x = 0.
inline std::vector<char> clamped_dofs(const TetMesh& mesh) {
  std::vector<char> flags(static_cast<std::size_t>(3 * mesh.node_count()), 0);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (mesh.nodes(0, i) < 1e-9) std::fill_n(flags.begin() + 3 * i, 3, char{1});
  }
  return flags;
}

/// Box of `cells` a side whose inner corners are moved by up to a fifth of a cell; edges stay straight.
inline TetMesh distorted_box(const Eigen::Vector3d& size, int cells, int order) {
  TetMesh mesh = make_box_mesh(size, cells, cells, cells, 1);
  const std::vector<char> outside = boundary_dofs(mesh);
  std::mt19937 engine(7);
  std::uniform_real_distribution<double> offset(-0.2, 0.2);
  for (int i = 0; i < mesh.node_count(); ++i) {
    if (outside[static_cast<std::size_t>(3 * i)] != 0) continue;
    for (int k = 0; k < 3; ++k) mesh.nodes(k, i) += offset(engine) * size[k] / cells;
  }
  if (order == 2) elevate_to_quadratic(mesh);
  return mesh;
}

/// Reproducible numbers from -size to size.
inline Eigen::VectorXd random_vector(Eigen::Index n, double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> value(-size, size);
  return Eigen::VectorXd::NullaryExpr(n, [&] { return value(engine); });
}

inline std::vector<int> all_elements(const Discretisation& fem) {
  std::vector<int> list(static_cast<std::size_t>(fem.element_count()));
  for (std::size_t e = 0; e < list.size(); ++e) list[e] = static_cast<int>(e);
  return list;
}

/// Small-strain stiffness of the whole body [N/m].
inline SparseMatrix linear_stiffness(const Discretisation& fem, const Lame& lame) {
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(fem.element_count());
  SparseMatrix stiffness = fem.volumetric_stiffness(ones);
  fem.make_elastic(lame.lambda, lame.mu, stiffness);
  return stiffness;
}

/// A body without damping under a constant load, linear or neo-Hookean.
class ElasticBody : public DynamicSystem {
 public:
  enum class Law { linear, neo_hookean };
  ElasticBody(const TetMesh& mesh, Law law, const Lame& lame, double density, std::vector<char> fixed)
      : fem_(mesh),
        law_(law),
        lame_(lame),
        solid_(fem_, all_elements(fem_)),
        mass_(density * fem_.mass(Eigen::VectorXd::Ones(fem_.element_count()))),
        stiffness_(linear_stiffness(fem_, lame)),
        fixed_(std::move(fixed)),
        load_(Eigen::VectorXd::Zero(fem_.dof_count())) {}

  void set_load(const Eigen::VectorXd& load) { load_ = load; }
  void set_damping(const SparseMatrix& damping) { damping_ = damping; }

  const Discretisation& fem() const { return fem_; }
  const SparseMatrix& mass() const override { return mass_; }
  const SparseMatrix& damping() const override { return damping_; }
  bool damped() const override { return damping_.size() > 0; }
  const std::vector<char>& fixed() const override { return fixed_; }

  void add_force(double, const Eigen::VectorXd& u, const Eigen::VectorXd&, Eigen::VectorXd& force) const override {
    force += load_;
    law_ == Law::linear ? subtract_product(stiffness_, u, force) : solid_.add_force(lame_, u, force);
  }
  SparseMatrix stiffness(double, const Eigen::VectorXd& u, const Eigen::VectorXd&) const override {
    if (law_ == Law::linear) return stiffness_;
    SparseMatrix k = fem_.pattern();
    solid_.add_stiffness(lame_, u, k);
    return k;
  }

  double kinetic_energy(const Eigen::VectorXd& v) const { return 0.5 * v.dot(mass_ * v); }
  double energy(const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
    const double stored = law_ == Law::linear ? 0.5 * u.dot(stiffness_ * u) : solid_.energy(lame_, u);
    return kinetic_energy(v) + stored - load_.dot(u);
  }

 private:
  Discretisation fem_;
  Law law_;
  Lame lame_;
  NeoHookean solid_;
  SparseMatrix mass_, damping_, stiffness_;
  std::vector<char> fixed_;
  Eigen::VectorXd load_;
};

/// Nodal forces of gravity along -z [N].
inline Eigen::VectorXd weight(const ElasticBody& body, double acceleration) {
  Eigen::VectorXd g = Eigen::VectorXd::Zero(body.fem().dof_count());
  for (Eigen::Index i = 2; i < g.size(); i += 3) g[i] = -acceleration;
  return body.mass() * g;
}

/// Displacement that balances the loads, with `prescribed` (3n) at the fixed degrees of freedom, by Newton's method from
/// `start`.
inline Eigen::VectorXd equilibrium(const ElasticBody& body, const Eigen::VectorXd& prescribed, const Eigen::VectorXd& start,
                                   int iterations = 30) {
  Eigen::VectorXd u = start;
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    if (body.fixed()[static_cast<std::size_t>(i)] != 0) u[i] = prescribed[i];
  }
  for (int k = 0; k < iterations; ++k) {
    Eigen::VectorXd r = body.force(0.0, u, rest);
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      if (body.fixed()[static_cast<std::size_t>(i)] != 0) r[i] = 0.0;
    }
    SparseMatrix tangent = body.stiffness(0.0, u, rest);
    fix_dofs(tangent, body.fixed(), tangent.diagonal().mean());
    SparseSolver solver;
    solver.factorize(tangent);
    const Eigen::VectorXd step = solver.solve(r);
    u += step;
    if (step.cwiseAbs().maxCoeff() < 1e-15 * (1.0 + prescribed.cwiseAbs().maxCoeff())) break;
  }
  return u;
}

}  // namespace tissue_stiffness
