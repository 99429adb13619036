#pragma once

#include <Eigen/Core>
#include <deque>
#include <vector>

#include "tissue_stiffness/fem/relaxation.hpp"
#include "tissue_stiffness/fem/sparse_solver.hpp"

namespace tissue_stiffness {

/// M a + C v + sum of relaxing branches = f(t, u, v) with some degrees of freedom held at zero.
class DynamicSystem {
 public:
  virtual ~DynamicSystem() = default;
  virtual const SparseMatrix& mass() const = 0;
  virtual const SparseMatrix& damping() const = 0;  ///< read only when damped()
  virtual bool damped() const = 0;
  virtual const std::vector<char>& fixed() const = 0;
  /// External minus internal force [N].
  virtual Eigen::VectorXd force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const = 0;
  /// -df/du, symmetric [N/m].
  virtual SparseMatrix stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const = 0;
  /// Branches whose force the state's history carries, and the stiffness they share (read only when there are any).
  virtual const std::vector<Relaxation>& relaxations() const;
  virtual const SparseMatrix& relaxing_stiffness() const { return mass(); }
};

/// Where a dynamic system stands.
struct DynamicState {
  double time = 0.0;
  Eigen::VectorXd displacement, velocity, acceleration;
  std::vector<Eigen::VectorXd> relaxed;  ///< z of each relaxing branch [m]; filled in by initialise, fully relaxed
};

/// Implicit steps of the generalised-alpha family (Chung & Hulbert 1993, eq. 7-19): second order, unconditionally stable.
/// Spectral radius 1 here means Newmark's average acceleration (beta = 1/4, gamma = 1/2), which keeps the energy of a
/// linear system. The balance is solved by quasi-Newton iterations (BFGS with a factored Jacobian of an earlier instant:
/// Matthies & Strang 1979), whose updates are carried from step to step; the factor is renewed when they converge slowly. A
/// step that still fails is cut in halves.
class Newmark {
 public:
  /// `tolerance`: largest last Newton correction [m].
  Newmark(const DynamicSystem& system, double spectral_radius, double tolerance);

  /// Fills in the acceleration that belongs to displacement and velocity, and a history of rest at this displacement.
  void initialise(DynamicState& state) const;
  /// Advances by `step` [s]. Throws NumericalError when ten halvings do not help; the state is then unchanged.
  void step(DynamicState& state, double step);

  int factorisations() const { return factorisations_; }
  int iterations() const { return iterations_; }

 private:
  bool try_step(DynamicState& state, double step);
  void accept(DynamicState& state, const Eigen::VectorXd& increment, double step);
  void cut_step(DynamicState& state, double step, int depth);
  void factorize(const DynamicState& middle, double step);
  Eigen::VectorXd residual(const DynamicState& state, const Eigen::VectorXd& increment, double step,
                           DynamicState& middle) const;

  const DynamicSystem& system_;
  double alpha_m_ = 0.0, alpha_f_ = 0.0, beta_ = 0.25, gamma_ = 0.5;
  double tolerance_;
  Eigen::VectorXd direction(const Eigen::VectorXd& residual) const;
  void learn(Eigen::VectorXd step, Eigen::VectorXd change);

  SparseSolver solver_;
  struct Update {
    Eigen::VectorXd step, change;  ///< of the unknown and of the residual, with its sign turned
    double inverse_curvature;      ///< 1 / step . change
  };
  std::deque<Update> updates_;
  double factored_step_ = 0.0;
  int factorisations_ = 0, iterations_ = 0;
};

}  // namespace tissue_stiffness
