#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// This is a posterior predictive test of a fit's residual. Missing physics moves the body along its lowest modes, which
/// smooth sensor noise does not. So the residual's weighted sum of squares is divided into the part along those modes and
/// the rest. Without missing physics both have the mean square of the noise a degree of freedom. The noise's level is that
/// of the differences between neighbouring points, where they are known, but no more than the rest's mean square. The
/// noise's memory from frame to frame tells how many independent frames there are (Bartlett 1946).
class MisfitTest {
 public:
  /// Adds a frame. residual: m; precision: m, weight / variance; shapes: m x k, the modes as the sensors see them.
  void add(const Eigen::VectorXd& residual, const Eigen::VectorXd& precision, const Eigen::MatrixXd& shapes);
  /// Adds a frame's differences between neighbouring points, of unit variance for noise as stated; 0: not known
  /// (observation/neighbour_differences).
  void add_differences(const Eigen::VectorXd& differences);

  /// Sets the degrees of freedom that the fit took of the part along the modes.
  void set_fitted(double dof) { fitted_ = dof; }
  /// Sets the mean square that mesh and basis leave of each row, along the modes and across them, in units of the noise's
  /// variance.
  void set_numerics(double along, double across = 0.0) { numerics_ = along, numerics_across_ = across; }
  /// Takes this off the sum of squares along the modes: what an error of known covariance explains of it. The sum's own
  /// variance under that error adds to the square of deviation(), times the squared degrees of freedom.
  void set_explained(double sum_of_squares, double variance) { explained_ = sum_of_squares, variance_ = variance; }
  /// Tolerates nothing of the numerics along the modes beyond what set_numerics() says, because all of it is known.
  void tolerate_no_more() { tolerated_ = 0.0; }

  /// Sets the noise level that another model of the same recording has shown. This model's residuals across the modes
  /// cannot hold more noise, so they are tested too.
  void set_noise(double level) { known_noise_ = level; }

  /// Returns the mean square along the modes a degree of freedom, of what is not explained, less noise_level() and what the
  /// numerics leave [stated noise variances].
  double excess() const;
  /// Returns the standard deviation of `excess` under noise and that error alone.
  double deviation() const;
  /// Returns (excess - max(t v, shared_noise)) / deviation with v = noise_level() and t = `tolerated`, or 0 after
  /// tolerate_no_more(). Where the noise is known from differences or by set_noise(), it returns the larger one of this and
  /// the same statistic across the modes.
  double z() const;
  /// Returns what the stated noise may have along the modes beyond its variance, 0 to 1 noise variances. The part of the
  /// stated variance that neighbouring points do not show, s = 1 - the mean square of their differences, is noise that
  /// neighbours share, at least two of them. Modes are smooth, so along them it counts twice: 1 - s + 2 s = 1 + s.
  double shared_noise() const;
  /// The test passes while z <= bound.
  bool passes() const { return z() <= bound; }
  /// Returns the mean square of what is unexplained, over all rows, in noise variances; 0 where it is no more than chance.
  double discrepancy() const;
  /// Returns the degrees of freedom along the modes.
  double structured_dof() const { return along_dof_; }
  /// Returns the noise's variance over the stated one: the least of the mean square of the residuals across the shapes,
  /// that of the differences and what set_noise() gave. It lies between 1 and `most_noise`.
  double noise_level() const;
  /// Returns the correlation of consecutive frames' differences, else of their residuals across the shapes, 0 to 0.95.
  double lag1_autocorrelation() const;
  bool empty() const { return frames_ == 0; }

  static constexpr double most_noise = 9.0;     ///< noise variances: noise beyond three times the stated one is a misfit
  static constexpr double tolerated = 1.0;      ///< of noise_level(): what numerics that are not known may leave
  static constexpr double bound = 3.0;          ///< standard deviations
  static constexpr double beyond_chance = 2.0;  ///< standard deviations from which on an excess is believed

 private:
  double along_ = 0.0, along_dof_ = 0.0, rest_ = 0.0, rest_dof_ = 0.0;
  /// Products of successive frames, for the autocorrelation.
  struct Successive {
    double product = 0.0, square = 0.0;
    Eigen::VectorXd last;

    void add(const Eigen::VectorXd& next);
  };
  Successive rests_, differences_;
  double difference_square_ = 0.0, difference_count_ = 0.0;
  double excess_across() const;
  double z_across() const;
  double repeated() const;  ///< frames that count as one, by the noise's autocorrelation

  double fitted_ = 0.0, explained_ = 0.0, variance_ = 0.0, tolerated_ = tolerated, numerics_ = 0.0, numerics_across_ = 0.0,
         known_noise_ = most_noise, rows_ = 0.0;
  int frames_ = 0;
};

/// Returns the shapes with one more column for each of these rows: 1 there, else 0. All of such a row's misfit counts. The
/// force of a sensor has no rest that would tell its noise.
Eigen::MatrixXd with_unit_columns(const Eigen::MatrixXd& shapes, const std::vector<Eigen::Index>& rows);

}  // namespace tissue_stiffness
