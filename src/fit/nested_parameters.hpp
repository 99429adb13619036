#pragma once

#include <Eigen/Core>
#include <vector>

#include "fit/recording_fit.hpp"

namespace tissue_stiffness {

/// What a model's free parameters have in common with those of `base`, a model with fewer effects or the model itself. Both
/// fits have to outlive it.
class NestedParameters {
 public:
  NestedParameters(const RecordingFit& fit, const RecordingFit& base);

  /// Returns the indices, in the model, of the free parameters that the base has too.
  const std::vector<Eigen::Index>& all() const { return all_; }
  /// Returns those of them that tune the body. What acts on it is left out.
  std::vector<Eigen::Index> tuning() const;
  /// Returns those of them along which a fit's start is scanned. A run that rings has other minima where its frequencies
  /// shift. Among the parameters that shift frequencies, only the one whose prior shifts them most is scanned, because the
  /// fit moves the others from there.
  std::vector<Eigen::Index> scanned() const;
  /// Returns those that are not tuning: what acts on the body.
  std::vector<Eigen::Index> acting() const;
  /// Returns whether a parameter of the model changes how the body answers a load, or when that is seen.
  bool tunes(Eigen::Index parameter) const;
  /// Converts `w` of the base to the coordinates of the model; parameters that the base lacks stay at their prior.
  Eigen::VectorXd extend(const Eigen::VectorXd& w) const;
  /// Returns the spread of the sigma points for a first fit from the fit of the base: narrow in its parameters, wide in the
  /// others.
  Eigen::VectorXd spread() const;

 private:
  const RecordingFit &fit_, &base_;
  std::vector<Eigen::Index> all_;
};

}  // namespace tissue_stiffness
