#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "diagnosis/comparison_numbers.hpp"
#include "diagnosis/explained.hpp"
#include "estimation/misfit_test.hpp"

namespace tissue_stiffness {

/// This is what the test of a residual says.
struct TestResult {
  double z = 0.0;
  bool passes() const { return z <= MisfitTest::bound; }
  /// Returns whether something beyond chance is left.
  bool structured() const { return z >= MisfitTest::beyond_chance; }
};

/// An assessment is what the comparison makes of one model.
struct Assessment {
  double log_evidence = 0.0;  ///< log p(e), up to a constant that all models share
  /// What the sensors see along the lowest modes says this, for each size of the mesh's error, up to a constant of each.
  Eigen::VectorXd log_modal_evidence;
  double log_likelihood = 0.0;  ///< log p(e | u) at the most probable u, up to the constant of log_evidence
  Eigen::VectorXd left;         ///< residual at the most probable u
  TestResult test;              ///< of `left`, because missing physics moves the lowest modes
  TestResult strict_test;       ///< the same with the smallest error of the mesh: what passes needs no search
};

/// The comparison assesses models of one recording by their residuals e at their fits. It takes all rows, in the noise's
/// stated standard deviations times the roots of their robust weights q:
///   e ~ N(J u, s I + sum_k B_k L_k B_k^T),  u ~ N(prior, I),  J = [columns, D],  s = v (1 + m) / (1 - m),
///   log p += sum log sqrt(q).
/// D is what a finer mesh changes, divided into its shares along the lowest modes and the rest. v is the mean square of
/// the differences between neighbouring points, which missing physics hardly moves, and m is their memory from frame to
/// frame. Both are those of the model that leaves least there. B_k L_k B_k^T, of frame k, is a displacement along the
/// lowest modes, because the mesh's error has directions that D does not hold. Its mean square is that of `least_of_mesh`
/// times what a refinement changes along each mode. The test weighs each direction i by its own error, which is r times as
/// large: the square b_i^2 of the residual counts b_i^2 v / (v + r^2 M_i). Here M is L over the number of frames that
/// count as one. The test averages its p-value over all sizes up to `whole_mesh`, evenly by their logarithm.
/// No coefficient of the numerics is believed beyond the standard deviations at which a test fails. The evidence is
/// Laplace's approximation (MacKay 2003, eq. 28.10) with the numerics as further unknowns. An added amplitude's prior is an
/// even mixture of normal ones from its stated width down to `smallest` of it. So an effect pays for the order of its size
/// and not for the width that a proposal happens to state.
///
/// The mesh's error has a known covariance along the lowest modes alone. So the modal evidence takes of each frame k only
/// Q_k^T e, where the columns of Q_k are orthonormal and span the lowest modes as the sensors see them, and each measured
/// force. It is told for several sizes r of that error, from the smallest to the largest. Its rows have no weights of their
/// own.
class ModelComparison {
 public:
  /// `mesh_change` is what a finer mesh changes of the base's rows [sigma].
  ModelComparison(const FittedModel& base, const Eigen::VectorXd& mesh_change);

  /// Replaces that change.
  void allow_for_mesh(const Eigen::VectorXd& change);
  /// Replaces the base by one with this residual, and that change. The lowest modes stay those of the first base.
  void move_base(const Eigen::VectorXd& error, const Eigen::VectorXd& mesh_change);
  /// Takes note of how little noise a residual shows, because all models share one noise.
  void note(const Eigen::VectorXd& error);
  /// Takes over the noise that another comparison of this recording has noted, where it is less.
  void note(const ModelComparison& other);
  double noise_variance() const { return noise_variance_; }  ///< s
  double base_cost() const { return base_cost_; }            ///< sum of squared errors of the base, which D is of
  const Eigen::MatrixXd& mesh_directions() const { return mesh_.columns; }  ///< D
  /// Returns what is allowed for a mesh whose refinement changes a model's rows by this [sigma].
  MeshAllowance allowance(const Eigen::VectorXd& change) const;
  /// Returns the rows (N x k) in which the covariance is s I: along B_k they shrink by the root of s / (s + L_k).
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& rows) const;
  /// Returns Q_k^T rows, frame under frame: modal_frames() has their frames.
  Eigen::MatrixXd along_modes(const Eigen::MatrixXd& rows) const;
  const FrameRows& modal_frames() const { return modal_frames_; }
  /// Returns log_evidence(rows) for each size of the mesh's error. The rows are along_modes(), and `log_evidence` gets them
  /// as those in which noise and that error have the covariance s I.
  Eigen::VectorXd by_mesh_error(const Eigen::MatrixXd& along,
                                const std::function<double(const Eigen::MatrixXd&)>& log_evidence) const;
  /// Assesses a model. Its evidence is compared with that of others, so it allows for the base's mesh. Its test allows for
  /// the error of its own mesh, where that is known.
  Assessment assess(const Explained& model) const;
  /// Tests a residual itself, of a model with `fitted` parameters, against the noise that is known so far. It allows for no
  /// error of the numerics.
  MisfitTest test_of(const Eigen::VectorXd& error, double fitted) const;
  /// Tests those of its rows that are `inside`, in the frames from `first` to before `last`.
  MisfitTest test_where(const Eigen::VectorXd& error, Eigen::Index first, Eigen::Index last,
                        const std::function<bool(Eigen::Index)>& inside) const;

 private:
  Assessment assess(const Explained& model, const MeshAllowance& mesh) const;
  /// Tests what a model with `fitted` parameters leaves.
  void test_left(double fitted, const MeshAllowance& mesh, Assessment& out) const;

  Eigen::VectorXd used_;   ///< 1 where a row says something, else 0
  Eigen::VectorXi nodes_;  ///< of each row, or kForceRow
  FrameRows frames_;
  std::vector<SparseMatrix> differences_;  ///< between neighbouring points, of each frame
  Eigen::MatrixXd along_;                  ///< rows / amplitude of each mode
  std::vector<Eigen::MatrixXd> modal_;     ///< Q_k of each frame
  FrameRows modal_frames_;                 ///< of the rows along them
  MeshAllowance mesh_;                     ///< of the base
  MeshAllowance modal_mesh_;               ///< the same of the rows along the modes, without `of_frame`
  double base_cost_ = 0.0;
  double noise_variance_ = 0.0;
  double noise_level_ = MisfitTest::most_noise;  ///< v
};

/// Returns the likelihood for models of two rounds on one recording. The noise is what both have shown. D is that of the
/// base that is closer to the recording, because what a mesh does to another motion is not what it does to the body's.
ModelComparison common_likelihood(const ModelComparison& one, const ModelComparison& other);

}  // namespace tissue_stiffness
