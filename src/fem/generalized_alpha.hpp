#pragma once

#include <Eigen/Core>
#include <limits>
#include <vector>

#include "fem/bfgs_updates.hpp"
#include "fem/relaxation.hpp"
#include "fem/sparse_solver.hpp"

namespace tissue_stiffness {

/// The system M a + C v + sum of relaxing branches = f(t, u, v), with some degrees of freedom held at zero.
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
  /// Returns -df/du, symmetric [N/m].
  virtual SparseMatrix stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const = 0;
  /// Returns the part of -df/dv that changes with the motion [N s/m]. It is read only when has_velocity_tangent().
  virtual bool has_velocity_tangent() const { return false; }
  virtual SparseMatrix friction(double, const Eigen::VectorXd&, const Eigen::VectorXd&) const { return {}; }
  /// Branches whose force depends on the history of a strain, and the stiffness that they share at rest. The latter, and
  /// the next two functions, are used only when there are any.
  virtual const std::vector<Relaxation>& relaxations() const;
  virtual const SparseMatrix& relaxing_stiffness() const { return mass(); }
  /// Computes that strain, which is the displacement itself in a linear system.
  virtual void find_relaxing_strain(const Eigen::VectorXd& u, Eigen::VectorXd& strain) const { strain = u; }
  /// Subtracts the branches' force at displacement u, where `stretch` is sum modulus (strain - z).
  virtual void subtract_relaxing_force(const Eigen::VectorXd& u, const Eigen::VectorXd& stretch,
                                       Eigen::VectorXd& force) const;
  /// Finds the deformation gradient of the material at each node, 3 x 3n, if the stiffness moves with the material.
  /// Otherwise `gradients` is empty.
  virtual void find_deformation(const Eigen::VectorXd&, Eigen::Matrix3Xd& gradients) const { gradients.resize(3, 0); }
};

/// Coefficients of the generalised-alpha family (Chung & Hulbert 1993, eq. 17, 18, 25).
struct AlphaCoefficients {
  /// `spectral_radius`: at infinite frequency; 1 is Newmark's average acceleration.
  explicit AlphaCoefficients(double spectral_radius);
  double alpha_m = 0.0, alpha_f = 0.0, beta = 0.25, gamma = 0.5;
};

/// State of a dynamic system at one instant.
struct DynamicState {
  double time = 0.0;
  Eigen::VectorXd displacement, velocity, acceleration;
  std::vector<Eigen::VectorXd> relaxed;  ///< z of each relaxing branch; initialise fills it in, fully relaxed
};

/// Gives a state without a history that of rest at its displacement.
void start_relaxed(const DynamicSystem& system, DynamicState& state);

/// Implicit time steps of the generalised-alpha family (Chung & Hulbert 1993, eq. 7-19), which is of second order and
/// unconditionally stable. Spectral radius 1 here means Newmark's average acceleration (beta = 1/4, gamma = 1/2), which
/// conserves the energy of a linear system.
///
/// The balance is solved by quasi-Newton iterations (BFGS: Matthies & Strang 1979) with the Jacobian J of an earlier
/// instant, which is pushed forward with the material: its inverse becomes F J^-1 F^T, where F is the deformation gradient
/// since that instant at each node. This keeps the divergence of a displacement (Piola's transformation, Marsden & Hughes
/// 1983, theorem 1.7.20), so that it serves nearly incompressible tissue, too. The factor is renewed when its age has cost
/// more iterations than a factorisation is worth, or when the iterations diverge. A step that still fails is cut in halves.
///
/// Similar systems of one size, such as a model at several parameters, are stepped together. The first one's factor serves
/// all of them, and each solution with it covers all their columns. A step that keeps the factor and is not cut allocates
/// no memory once earlier steps have allocated its buffers.
class GeneralizedAlpha {
 public:
  /// `tolerance`: largest correction that is neglected [m]. The systems must hold the same degrees of freedom.
  GeneralizedAlpha(std::vector<const DynamicSystem*> systems, double spectral_radius, double tolerance);
  GeneralizedAlpha(const DynamicSystem& system, double spectral_radius, double tolerance);

  /// Computes the acceleration that belongs to displacement and velocity. A missing history becomes that of rest at this
  /// displacement.
  void initialise(std::vector<DynamicState>& states) const;
  void initialise(DynamicState& state) const;
  /// Advances each system by its step [s]. The steps may differ by a few percent. Throws NumericalError when ten halvings
  /// do not help; the states are then unchanged.
  void step(std::vector<DynamicState>& states, const std::vector<double>& steps);
  void step(DynamicState& state, double step);

  int factorisations() const { return factorisations_; }
  int iterations() const { return iterations_; }

  /// Returns the share of the state before in the forces that a step balances, alpha_f.
  double force_share() const { return alpha_.alpha_f; }

 private:
  /// One system during a step.
  struct Column {
    const DynamicSystem* system;
    const DynamicState* before = nullptr;
    double step = 0.0;
    DynamicState middle;  ///< at the weighted instants
    Eigen::VectorXd increment, residual, direction;
    Eigen::VectorXd next_increment, next_residual;  ///< of the correction that is being tried
    Eigen::VectorXd strain_before, strain;          ///< of the relaxing branches: before the step, and at `middle`
    Eigen::VectorXd stretch;                        ///< sum modulus (strain - z) of the relaxing branches
    BfgsUpdates updates;
    double last = 0.0;  ///< size of the last correction
    double rate = 1.0;  ///< ratio of the last two corrections
    bool done = false;
    Eigen::Matrix3Xd deformation;                               ///< of each node since the factor was made, or empty
    Eigen::VectorXd last_increment, earlier_increment;          ///< of the last two steps
    double last_step = 0.0, earlier_step = 0.0;                 ///< their lengths [s]; 0: no such step
    double reached = std::numeric_limits<double>::quiet_NaN();  ///< time after the last step [s]
  };
  enum class Progress { going, done, slow, failed };

  bool try_step(std::vector<DynamicState>& states, const std::vector<double>& steps);
  void cut_step(std::vector<DynamicState>& states, const std::vector<double>& steps, int depth);
  /// Iterates until all columns are done. Returns the number of iterations, or 0 when they diverge.
  int iterate();
  bool start();
  void find_directions();
  Progress judge(int iteration);
  /// Returns false when a column cannot move.
  bool move();
  bool move(Column& column) const;
  void factorize(const Column& column);
  void push_forward();
  void note_age(int iterations);
  void find_acceleration(const Column& column, const Eigen::VectorXd& increment, Eigen::VectorXd& acceleration) const;
  void find_residual(Column& column, const Eigen::VectorXd& increment, Eigen::VectorXd& residual) const;
  void accept(Column& column, DynamicState& state) const;

  AlphaCoefficients alpha_;
  double tolerance_;
  std::vector<Column> columns_;
  std::vector<Column*> active_;  ///< columns that are not done
  Eigen::MatrixXd directions_;   ///< of the active columns, in its first columns
  SparseSolver solver_;
  Eigen::Matrix3Xd factored_inverse_;  ///< inverse of each node's deformation gradient when the factor was made
  double factored_step_ = 0.0;
  /// Mean iterations of the first steps with this factor and with the last one, and the sum of later iterations beyond
  /// them.
  double young_ = 0.0, young_before_ = 0.0, excess_ = 0.0;
  int steps_ = 0;       ///< number of steps since the factor was renewed
  double worth_ = 1.0;  ///< doubles while renewals do not help
  int factorisations_ = 0, iterations_ = 0;
};

}  // namespace tissue_stiffness
