#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "forward/full_model.hpp"

namespace tissue_stiffness {

/// Motions of runs in full, which a hyper-reduced model is trained with.
struct FullMotions {
  Eigen::MatrixXd displacements;        ///< a snapshot in each column, 3n x snapshots [m]
  std::vector<Eigen::VectorXd> thetas;  ///< parameters of each

  /// Adds the snapshots of `other`.
  void add(const FullMotions& other);
  /// Returns at most `count` of them, evenly spread.
  FullMotions thinned(Eigen::Index count) const;
};

struct HyperOptions {
  FullModel::Options full;    ///< of the runs in full that it stands for; its steps are theirs
  int largest = 20;           ///< vectors
  double energy_left = 1e-8;  ///< share of the snapshots' energy that the vectors may leave out
  double force_left = 3e-4;   ///< share of their elastic forces that the sampled points may leave out
  int most_points = 300;      ///< sampled points
  int candidates = 3000;      ///< quadrature points that they are chosen from
  int states = 24;            ///< snapshots whose forces choose them

  /// Returns options with more vectors and points, up to a limit.
  HyperOptions finer() const;
};

/// A quadrature point that stands for the elastic work around it.
struct SampledPoint {
  int element, point;
  double weight;  ///< [m^3]
};

/// Vectors and points that stand for a model under finite strain.
struct HyperBasis {
  Eigen::MatrixXd vectors;  ///< V, 3n x m, M-orthonormal; K is diagonal in them, ascending
  Eigen::VectorXd square;   ///< its diagonal over that of M [rad^2/s^2]
  std::vector<SampledPoint> points;
  Eigen::MatrixXd gradients;  ///< of the vectors at the points: nine rows each, entry (i, J) in row i + 3 J
  double force_left = 0.0;    ///< share of the training forces that the points leave out
  double trained = 0.0;       ///< largest energy of the training states, see energy()

  /// Returns twice the elastic energy of the coordinates q at small strain, sum omega_i^2 q_i^2 [J].
  double energy(const Eigen::VectorXd& q) const { return square.dot(q.cwiseAbs2()); }
};

/// Chooses vectors and points. The vectors are the proper orthogonal decomposition of the snapshots, in the inner product
/// of the stiffness at rest (with a share of the mass for motions without strain). The points' weights solve
///   sum over points of w_p G_p^T P(F_p) = V^T f(u)   with w_p >= 0
/// for elastic forces f of the snapshots, and likewise for those of each vector at rest (energy-conserving sampling and
/// weighting: Farhat, Avery, Chapman & Cortial 2014, eq. 19, at points in place of elements: Hernandez, Caicedo & Ferrer
/// 2017). Each force is measured in the energy norm of the stiffness at rest. Weights that are positive keep the forces the
/// gradient of an energy.
HyperBasis choose_hyper_basis(const Model& model, const FullMotions& motions, const HyperOptions& options);

/// Returns why a model cannot be hyper-reduced; empty: it can.
std::string why_not_hyper_reduced(const Model& model);

}  // namespace tissue_stiffness
