#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "diagnosis/hypotheses.hpp"
#include "diagnosis/refit.hpp"
#include "diagnosis/screening.hpp"

namespace tissue_stiffness {

/// Times the best cost so far: fewer parameters may compensate for less than that.
constexpr double kReach = 1.05;

/// Returns the number of parameters that are fitted besides the base's.
std::ptrdiff_t parameters_of(const Candidate& candidate);

class RefitList;

/// It hears of all refits so far, whenever there are more.
using RefitsSoFar = std::function<void(const RefitList&)>;

/// The list holds the refits of one round: best first, one for each effect.
class RefitList {
 public:
  RefitList(Screening& screening, const DiagnosisOptions& options, RefitsSoFar so_far)
      : screening_(screening),
        options_(options),
        so_far_(std::move(so_far)),
        comparison_(screening.comparison),
        base_(std::make_shared<const Explained>(screening.explained)),
        given_(screening.given) {}

  /// Refits each of these tasks, side by side. What falls behind the best so far is not fitted to the end. Where the
  /// recording's checkpoint throws Interrupted, those that were fitted by then are kept.
  void add(std::vector<RefitTask> list) { add(std::move(list), screening_.least_gain()); }
  /// Likewise. A nonlinear model is run in full where its first order explains more than `least_gain` [sigma^2].
  void add(std::vector<RefitTask> list, double least_gain);

  /// Fits the given model as refits are fitted: from the best place near its fit, or from where a refit has its parameters.
  /// A refit that has found another minimum may have found it for the given model, too. Returns true if the new fit is
  /// better; the round's base is then there.
  bool move_to_better_base();
  bool base_moved() const { return base_moved_; }
  /// Tests the best refit as if it were the given model, if it is more probable than that: with a reduced basis that is
  /// chosen at its fit, and with the error of its own mesh. Nothing changes where no finer mesh can be run. A nonlinear
  /// refit of a linear model is tested so from the beginning, because the error of its mesh is a part of the motion.
  void test_best_by_own_numerics();

  bool empty() const { return refits_.empty(); }
  const std::vector<Refit>& all() const { return refits_; }
  const Refit& best() const { return refits_.front(); }
  /// Compares the given model, each refit, and something unknown beside the given model and beside the best refit.
  const Comparison& compare();
  const Assessment& given() const { return given_; }  ///< of the given model
  const ModelComparison& comparison() const { return comparison_; }
  /// Returns whether the base leaves noise alone, with no error of the mesh allowed for.
  bool passes_without_mesh() const;
  const std::string& failure() const { return failure_; }  ///< why the last model that could not be run failed
  std::vector<Refit> take() { return std::move(refits_); }

  /// Does each piece of work on a core of its own, and tells its name. A model that cannot be run is left out.
  void try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                const std::function<void(std::size_t)>& work);

 private:
  /// Returns how many variants of an effect the library proposes.
  double variants_of(const std::string& effect) const;
  void keep(std::vector<std::optional<Refit>> done);
  /// Tests a refit that has its model with the error of its own mesh, and not of the base's.
  void test_by_own_mesh(const FinerMesh& finer, Refit& refit);
  void assess();
  void drop_worse_variants();

  Screening& screening_;
  const DiagnosisOptions& options_;
  RefitsSoFar so_far_;
  ModelComparison comparison_;
  std::shared_ptr<const Explained> base_;          ///< the given model as it is compared
  Assessment given_;                               ///< of the given model
  std::shared_ptr<const RandomForce> base_force_;  ///< null until it is needed
  std::vector<Refit> refits_;
  std::optional<Comparison> compared_;  ///< empty after a new refit or another base
  bool base_moved_ = false;
  std::string failure_;
};

}  // namespace tissue_stiffness
