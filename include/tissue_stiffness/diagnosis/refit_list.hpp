#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/diagnosis/first_look.hpp"

namespace tissue_stiffness {

constexpr double kSameEvidence = 5.0;  // log evidence within which refits are not told apart

/// Evidence of a refit after Schwarz, errors counted as large as `variance` [sigma^2].
double evidence(const Refit& refit, double rows, double variance);

/// Parameters that are fitted besides the base's.
std::ptrdiff_t parameters_of(const std::vector<Addition>& additions);

/// Hears of all refits so far, best first, whenever there are more.
using RefitsSoFar = std::function<void(const std::vector<Refit>&)>;

/// The refits of one look: best first, one an effect (or pair), compared beside the numerics.
class RefitList {
 public:
  RefitList(const FirstLook& look, const DiagnosisOptions& options, RefitsSoFar so_far)
      : look_(look), options_(options), so_far_(std::move(so_far)) {}

  /// Refits with each of these additions, side by side. What falls behind the best so far is not fitted to the end; where
  /// the recording's checkpoint throws Interrupted, those that were fitted by then are kept.
  void add(std::vector<std::vector<Addition>> list);
  /// A recording may be simulated itself: what its time steps do decides between twins, and may be all that an effect
  /// leaves. Believed only where an explanation leaves noise beside them: what is wrong otherwise is not theirs.
  void compare_beside_steps();
  /// Where the mesh's error is much of what the leaders leave, the one that imitates it best would win.
  void compare_on_finer_mesh();

  bool empty() const { return refits_.empty(); }
  const std::vector<Refit>& all() const { return refits_; }
  const Refit& best() const { return refits_.front(); }
  bool holds(const std::string& effect) const;
  /// The best one explains the error.
  bool explains() const { return !empty() && look_.explained_by(best()); }
  bool leaves_more_than_noise() const { return empty() || !is_noise(best().cost_beside_steps); }
  bool mesh_counts() const;
  /// Of the base's sum of squared errors beside a simulation's time steps.
  double left_beside_steps();
  std::vector<Refit> take() { return std::move(refits_); }

  /// Each on a core of its own, told by name; what a model that cannot be run would find is left out.
  void try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                const std::function<void(std::size_t)>& work) const;

 private:
  bool is_noise(double cost) const;
  void keep(std::vector<std::optional<Refit>> done);
  void add_steps();
  void sort();
  void drop_worse_ways();

  const FirstLook& look_;
  const DiagnosisOptions& options_;
  RefitsSoFar so_far_;
  std::vector<Refit> refits_;
  std::optional<double> left_beside_steps_;
};

}  // namespace tissue_stiffness
