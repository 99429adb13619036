#pragma once

#include <optional>

#include "tissue_stiffness/estimation/change.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"

namespace tissue_stiffness {

/// Watches the misfit for a rise above what it was at its best, which says that a drifting parameter may have changed.
class ChangeWatch {
 public:
  /// drifts: some parameter does; otherwise nothing is ever suspected.
  explicit ChangeWatch(bool drifts) : drifts_(drifts) {}

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

  bool drifts_;
  int frames_ = 0;
  double recent_ = 0.0, average_ = 0.0;  ///< of the misfit, over a few frames and over more
  double least_ = 0.0;                   ///< that the latter was
  std::optional<ChangeQuestion> steady_;
  int suspicious_ = 0;  ///< frames since it rose
  int next_ = kSearchEvery;
};

}  // namespace tissue_stiffness
