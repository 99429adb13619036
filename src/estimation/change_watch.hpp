#pragma once

#include <optional>

#include "estimation/change.hpp"
#include "filter/posterior_linearization_filter.hpp"

namespace tissue_stiffness {

/// The watch waits for a rise of the misfit above its best level. Such a rise says that a drifting parameter may have
/// changed.
class ChangeWatch {
 public:
  /// `drifts` says whether some parameter drifts; otherwise nothing is ever suspected.
  explicit ChangeWatch(bool drifts) : drifts_(drifts) {}

  /// Takes a frame's mean square error over sigma, and the filter after it.
  void add(double square, const PosteriorLinearizationFilter& filter);
  bool suspicious() const { return suspicious_ > 0; }
  /// If a change were the cause, a search would have found it by now.
  bool searched() const { return suspicious_ > kSearchedFirst; }
  /// Returns what to search with, from time to time while the misfit is suspicious.
  std::optional<ChangeQuestion> due();
  void restart();
  /// Starts anew after a change, but keeps the misfit's best level.
  void go_on();

 private:
  static constexpr int kSearchedFirst = 12, kSearchEvery = 3;  // suspicious frames
  bool risen() const;
  double usual() const;

  bool drifts_;
  int frames_ = 0;
  double recent_ = 0.0, average_ = 0.0;  ///< of the misfit, over a few frames and over more
  double least_ = 0.0;                   ///< lowest value of average_
  std::optional<ChangeQuestion> steady_;
  int suspicious_ = 0;  ///< frames since the misfit rose
  int next_ = kSearchEvery;
};

}  // namespace tissue_stiffness
