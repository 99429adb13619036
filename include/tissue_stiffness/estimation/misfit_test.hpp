#pragma once

#include <Eigen/Core>
#include <string>

namespace tissue_stiffness {

/// Posterior predictive test of a fit's residual. What physics misses moves the body along its lowest modes, which smooth
/// sensor noise does not: the residual's weighted sum of squares is divided into the part along those modes and the rest.
/// Without missing physics both have the same mean square a degree of freedom, whatever the noise's level; the rest's
/// memory from frame to frame tells how many independent frames there are (Bartlett 1946).
class MisfitTest {
 public:
  /// residual: m; precision: m, weight / variance; shapes: m x k, the modes as the sensors see them.
  void add(const Eigen::VectorXd& residual, const Eigen::VectorXd& precision, const Eigen::MatrixXd& shapes);

  /// Degrees of freedom that the fit took of the part along the modes.
  void set_fitted(double dof) { fitted_ = dof; }
  /// Mean square, in units of the noise's variance, that the mesh and the basis leave of each row, along the modes and
  /// across them.
  void set_numerics(double along, double across = 0.0) { numerics_ = along, numerics_across_ = across; }

  /// Level of the noise that another model of the same recording has shown. This one's residuals across the modes cannot
  /// have more, and are tested, too.
  void set_noise(double level) { known_noise_ = level; }

  /// Mean square along the modes a degree of freedom beyond what noise and numerics leave [noise variances].
  double excess() const;
  /// Standard deviation of `excess` under noise alone.
  double deviation() const;
  /// (excess - tolerated) / deviation; the larger one of both parts where the noise is known.
  double z() const;
  /// Passed while z <= bound.
  bool passes() const { return z() <= bound; }
  /// Mean square of what is unexplained, over all rows, in noise variances; 0 where it is no more than chance.
  double discrepancy() const;
  /// Degrees of freedom along the modes.
  double structured_dof() const { return along_dof_; }
  /// Mean square of the residuals across the shapes a degree of freedom, in noise variances, between 1 and `most_noise`, or
  /// what is known of it if that is less.
  double noise_level() const;
  /// Correlation of consecutive frames' residuals across the shapes, 0 to 0.95.
  double memory() const;
  bool empty() const { return frames_ == 0; }

  static constexpr double most_noise = 9.0;  ///< noise variances: noise beyond three times the stated one is a misfit
  static constexpr double tolerated = 1.0;   ///< noise variances: unexplained motion below one frame's noise
  static constexpr double bound = 3.0;       ///< standard deviations

 private:
  double along_ = 0.0, along_dof_ = 0.0, rest_ = 0.0, rest_dof_ = 0.0;
  double product_ = 0.0, square_ = 0.0;  ///< of successive frames' rest, for its memory
  double excess_across() const;
  double z_across() const;
  double repeated() const;  ///< frames that count as one, by the memory of the noise

  double fitted_ = 0.0, numerics_ = 0.0, numerics_across_ = 0.0, known_noise_ = most_noise, rows_ = 0.0;
  int frames_ = 0;
  Eigen::VectorXd last_;
};

}  // namespace tissue_stiffness
