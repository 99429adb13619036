#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "tissue_stiffness/fem/bfgs_updates.hpp"
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
  /// Adds external minus internal force [N].
  virtual void add_force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& force) const = 0;
  Eigen::VectorXd force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const;
  /// -df/du, symmetric [N/m].
  virtual SparseMatrix stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const = 0;
  /// The part of -df/dv that changes with the motion [N s/m]; read only when rubs().
  virtual bool rubs() const { return false; }
  virtual SparseMatrix friction(double, const Eigen::VectorXd&, const Eigen::VectorXd&) const { return {}; }
  /// Branches whose force the state's history carries, and the stiffness they share (read only when there are any).
  virtual const std::vector<Relaxation>& relaxations() const;
  virtual const SparseMatrix& relaxing_stiffness() const { return mass(); }
  /// How far the material turned at each node, 3 x 3n, where the stiffness turns with it; nothing where it does not.
  virtual void find_rotations(const Eigen::VectorXd&, Eigen::Matrix3Xd& rotations) const { rotations.resize(3, 0); }
};

/// Where a dynamic system stands.
struct DynamicState {
  double time = 0.0;
  Eigen::VectorXd displacement, velocity, acceleration;
  std::vector<Eigen::VectorXd> relaxed;  ///< z of each relaxing branch [m]; filled in by initialise, fully relaxed
};

/// Implicit steps of the generalised-alpha family (Chung & Hulbert 1993, eq. 7-19): second order, unconditionally stable.
/// Spectral radius 1 here means Newmark's average acceleration (beta = 1/4, gamma = 1/2), which keeps the energy of a
/// linear system.
///
/// The balance is solved by quasi-Newton iterations (BFGS: Matthies & Strang 1979) around one Jacobian of an earlier
/// instant, turned with the material. The factor is renewed when the iterations that its age has cost outweigh a
/// factorisation, or when they diverge. A step that still fails is cut in halves.
///
/// Systems of one size that differ little - a model at several parameters - step side by side: the first one's factor
/// serves all, and they go through it together. A step that keeps the factor and is not cut asks the heap for nothing
/// once others have made its buffers.
class Newmark {
 public:
  /// `tolerance`: largest correction that is left out [m]. Systems must hold the same degrees of freedom.
  Newmark(std::vector<const DynamicSystem*> systems, double spectral_radius, double tolerance);
  Newmark(const DynamicSystem& system, double spectral_radius, double tolerance);

  /// Fills in the acceleration that belongs to displacement and velocity, and where there is no history yet one of rest at
  /// this displacement.
  void initialise(std::vector<DynamicState>& states) const;
  void initialise(DynamicState& state) const;
  /// Advances each system by its step [s]; the steps may differ by parts in a hundred. Throws NumericalError when ten
  /// halvings do not help; the states are then unchanged.
  void step(std::vector<DynamicState>& states, const std::vector<double>& steps);
  void step(DynamicState& state, double step);

  int factorisations() const { return factorisations_; }
  int iterations() const { return iterations_; }

 private:
  /// One system within a step.
  struct Column {
    const DynamicSystem* system;
    const DynamicState* before = nullptr;
    double step = 0.0;
    DynamicState middle;  ///< at the weighted instants
    Eigen::VectorXd increment, residual, direction;
    Eigen::VectorXd next_increment, next_residual;  ///< of the correction that is tried
    Eigen::VectorXd stretch;                        ///< what relaxing branches pull at
    BfgsUpdates updates;
    double last = 0.0;  ///< size of the last correction
    double rate = 1.0;  ///< at which they shrink
    bool done = false;
    Eigen::VectorXd earlier_acceleration;                       ///< before the last step
    double reached = std::numeric_limits<double>::quiet_NaN();  ///< time after it [s]
  };
  enum class Progress { going, done, slow, failed };

  bool try_step(std::vector<DynamicState>& states, const std::vector<double>& steps);
  void cut_step(std::vector<DynamicState>& states, const std::vector<double>& steps, int depth);
  /// Until all columns are done; the number of iterations, 0 when they diverge.
  int iterate();
  bool start();
  void find_directions();
  Progress judge(int iteration);
  /// False when a column cannot move.
  bool move();
  bool move(Column& column) const;
  void factorize(const Column& column);
  void turn();
  void note_age(int iterations);
  void find_acceleration(const Column& column, const Eigen::VectorXd& increment, Eigen::VectorXd& acceleration) const;
  void find_residual(Column& column, const Eigen::VectorXd& increment, Eigen::VectorXd& residual) const;
  void accept(Column& column, DynamicState& state) const;

  double alpha_m_ = 0.0, alpha_f_ = 0.0, beta_ = 0.25, gamma_ = 0.5;
  double tolerance_;
  std::vector<Column> columns_;
  std::vector<Column*> active_;  ///< those that are not done
  Eigen::MatrixXd directions_;   ///< of the active ones, the first columns
  SparseSolver solver_;
  Eigen::Matrix3Xd factored_rotations_, turn_;  ///< of each node; the second: since the factor was made
  bool turned_ = false;                         ///< there is such a turn
  double factored_step_ = 0.0;
  /// Iterations a step: over the first steps of this factor and of the last one, and what its age has cost beyond them.
  double young_ = 0.0, young_before_ = 0.0, excess_ = 0.0;
  int steps_ = 0;       ///< since the factor was renewed
  double worth_ = 1.0;  ///< grows while renewals do not help
  int factorisations_ = 0, iterations_ = 0;
};

}  // namespace tissue_stiffness
