#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "tissue_stiffness/estimation/choose_correction.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"

namespace tissue_stiffness {

/// Parameters that changed while the body moved.
struct Change {
  RunStart from;          ///< when, and how the body moved then
  Eigen::VectorXd w;      ///< after it, filter coordinates
  Eigen::VectorXd doubt;  ///< of them, about 1 sigma, because of what is not known of the instant and of what was before
  std::size_t first = 0;  ///< frame after it
};

/// What is known before a change.
struct ChangeQuestion {
  Eigen::VectorXd w;           ///< parameters before it, filter coordinates
  Eigen::MatrixXd covariance;  ///< their posterior then
  Eigen::VectorXd drift;       ///< standard deviation of each after a second; 0 where it is constant
  double misfit = 1.0;         ///< mean square error over sigma before it
  std::optional<double> near;  ///< about when [s]; empty: somewhen in the last frames
};

/// How far the parameters may have drifted over `span` [s], variance of each; of a second at least.
Eigen::VectorXd drifted(const ChangeQuestion& question, double span);

/// The change that explains the last frames: looks back from the newest over instants and, at each, along every
/// drifting coordinate, for where the sum of squared errors over sigma and of the change over its own standard deviation is
/// least; then closer around the best. Empty where that is not clearly less than without a change (by 20 and by four fifths
/// of what the misfit exceeds the one before), as it is for physics that the model lacks. Throws NumericalError as runs do.
std::optional<Change> find_change(const FitProblem& problem, const ChangeQuestion& question);

/// Watches the misfit for a rise above what it was at its best, which says that a drifting parameter may have changed.
class ChangeWatch {
 public:
  /// drift: see ChangeQuestion; all zero: nothing is ever suspected.
  explicit ChangeWatch(const Eigen::VectorXd& drift) : drift_(drift) {}

  /// Mean square error over sigma of a frame, and the filter after it.
  void add(double square, const AnchoredFilter& filter);
  bool suspicious() const { return suspicious_ > 0; }
  /// A change would have been found by now, if it were one.
  bool searched() const { return suspicious_ > kSearchedFirst; }
  /// What to search with, now and then while it is suspicious.
  std::optional<ChangeQuestion> due();
  void restart();
  /// After a change: the misfit at its best is still known.
  void go_on();

 private:
  static constexpr int kSearchedFirst = 12, kSearchEvery = 3;  // suspicious frames
  bool risen() const;
  double usual() const;

  Eigen::VectorXd drift_;
  int frames_ = 0;
  double recent_ = 0.0, average_ = 0.0;  ///< of the misfit, over a few frames and over more
  double least_ = 0.0;                   ///< that the latter was
  std::optional<ChangeQuestion> steady_;
  int suspicious_ = 0;  ///< frames since it rose
  int next_ = kSearchEvery;
};

}  // namespace tissue_stiffness
