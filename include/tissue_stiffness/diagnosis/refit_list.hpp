#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/diagnosis/first_look.hpp"

namespace tissue_stiffness {

/// Parameters that are fitted besides the base's.
std::ptrdiff_t parameters_of(const Candidate& way);

class RefitList;

/// Hears of all refits so far, whenever there are more.
using RefitsSoFar = std::function<void(const RefitList&)>;

/// The refits of one look: best first, one an effect.
class RefitList {
 public:
  RefitList(FirstLook& look, const DiagnosisOptions& options, RefitsSoFar so_far)
      : look_(look),
        options_(options),
        so_far_(std::move(so_far)),
        comparison_(look.comparison),
        base_(std::make_shared<const Explained>(look.explained)),
        given_(look.given) {}

  /// Refits with each of these additions, side by side. What falls behind the best so far is not fitted to the end; where
  /// the recording's checkpoint throws Interrupted, those that were fitted by then are kept.
  void add(std::vector<Addition> list);

  /// Fits the given model as refits are fitted: from the best place near its fit, or from where a refit has its parameters.
  /// A refit that has found another minimum may have found it for the given model, too. True if that fits better: the
  /// look's base is there then.
  bool move_to_better_base();
  bool base_moved() const { return base_moved_; }

  bool empty() const { return refits_.empty(); }
  const std::vector<Refit>& all() const { return refits_; }
  const Refit& best() const { return refits_.front(); }
  /// The given model, each refit, and something unknown beside the given model and beside the best refit.
  const Comparison& compare();
  const Assessment& given() const { return given_; }  ///< of the given model
  /// Log evidence of a refit beyond the given model's, over all ways of its effect, of which one was fitted.
  double log_bayes_factor(const Refit& refit) const;
  const ModelComparison& comparison() const { return comparison_; }
  std::vector<Refit> take() { return std::move(refits_); }

  /// Each on a core of its own, told by name; what a model that cannot be run would find is left out.
  void try_each(std::size_t count, const std::function<std::string(std::size_t)>& name,
                const std::function<void(std::size_t)>& work) const;

 private:
  /// How many ways of an effect the library proposes.
  double ways_of(const std::string& effect) const;
  void keep(std::vector<std::optional<Refit>> done);
  void assess();
  void drop_worse_ways();

  FirstLook& look_;
  const DiagnosisOptions& options_;
  RefitsSoFar so_far_;
  ModelComparison comparison_;
  std::shared_ptr<const Explained> base_;          ///< the given model as it is compared
  Assessment given_;                               ///< of it
  std::shared_ptr<const RandomForce> base_force_;  ///< null until it is asked for
  std::vector<Refit> refits_;
  std::optional<Comparison> compared_;  ///< empty where there is a refit or another base since
  bool base_moved_ = false;
};

}  // namespace tissue_stiffness
