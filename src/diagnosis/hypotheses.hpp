#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/model_comparison.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

struct RandomForce;

/// A hypothesis is a fitted model in the comparison, with its probability.
struct Hypothesis {
  std::vector<std::string> effects;  ///< empty: the given model
  /// It also acts on the lowest modes: something that the library does not have. Null: nothing does.
  std::shared_ptr<const RandomForce> random_force;
  double log_prior = 0.0;                      ///< of the hypothesis
  double log_prior_of_force = 0.0;             ///< the random force's part of it
  std::shared_ptr<const Explained> explained;  ///< the model
  double log_evidence = 0.0;                   ///< up to a constant
  Eigen::VectorXd log_modal_evidence;          ///< along the lowest modes, for each size of the mesh's error
  double log_weight = 0.0;                     ///< evidence that is believed plus prior, both logarithms
  TestResult test;                             ///< of its residual; with a random force, of that without it
  bool superfluous = false;                    ///< another hypothesis already suffices
  double probability = 0.0;
  bool holds(const std::string& effect) const;
  bool same_effects(const Hypothesis& other) const;  ///< in whichever order they were added
  /// Returns whether this one has all that the other one has and something more.
  bool extends(const Hypothesis& other) const;
  /// Returns whether this one extends another one that leaves no structure beyond chance, with a random force or with a
  /// gain of no more than twice `worthwhile`.
  bool superfluous_beside(const Hypothesis& other) const;
  /// Sets evidence and test as `models` assess the explained model.
  void weigh(const Assessment& assessment, const ModelComparison& models);
};
/// A trace is a hypothesis that no test asks for, with its share of the belief where its evidence still counts.
struct Trace {
  const Hypothesis* hypothesis;
  double share;
};
struct Comparison {
  bool passes_without_mesh = false;    ///< the given model's residual passes, with the error of the mesh in it
  std::vector<Hypothesis> hypotheses;  ///< the given model first

  const Hypothesis& given() const { return hypotheses.front(); }
  const Hypothesis& best() const;                          ///< most probable one
  double none_of_these() const;                            ///< probability of all hypotheses with a random force
  double probability_of(const std::string& effect) const;  ///< probability of all others that hold it
  /// Returns what may act besides the most probable hypothesis without being missed: superfluous extensions of it, by their
  /// whole evidence. Together they have no more than half, because the evidence may be that of the mesh's error.
  std::vector<Trace> traces() const;
  /// Assigns evidences, tests and probabilities to all hypotheses by one likelihood. Sets that were fitted in several
  /// orders are one hypothesis: the likeliest fit.
  void assess(const ModelComparison& models);
  /// Computes weights and probabilities from the evidences and tests. An extension of a model gains over it no more than
  /// believed_gain() says. A superfluous hypothesis has no probability, because what it has more is too small to be
  /// missing. Only a random force beside the most probable named model keeps its prior then, because something unknown may
  /// act in the place of what is named. All random forces together gain over the most probable model what one beside it
  /// gains.
  void find_probabilities();
  /// `deeper` is a comparison about the model with `effects` added. Its hypotheses take the place of those with these
  /// effects alone, and have to be assessed together with the others.
  void merge(const std::vector<std::string>& effects, const Comparison& deeper);

 private:
  void drop_worse_twins();
};

/// Returns `adequate` if the given model is believed (P(given) > 1 - `believed`) and its residual passes, `numerics` if it
/// passes only with an error of the mesh. Returns `missing` if it is not believed, named effects alone are the most
/// probable hypothesis, what they leave passes, and "none of these" is less probable than not. Otherwise it returns
/// `unexplained`.
Verdict judge(const Comparison& comparison);

/// Returns the hypotheses that name any effect, with their probabilities among each other, most probable first.
std::vector<Hypothesis> named_hypotheses(const Comparison& comparison);

/// Returns the effects of the fewest hypotheses that hold the believed part of the probability of all that name any effect,
/// most probable first.
std::vector<std::string> believed_effects(const Comparison& comparison);

}  // namespace tissue_stiffness
