#pragma once

namespace tissue_stiffness {

/// A comparison decides by these numbers.
struct ComparisonNumbers {
  double believed = 0.95;         ///< posterior probability that the set of explanations has to hold
  double whole_mesh = 4.0 / 3.0;  ///< of what a mesh refined once changes, at second order: error of any mesh as fine
  double least_of_mesh = 0.5;     ///< of what a mesh refined once changes: smallest error in directions that D lacks
  double unknown_mesh = 0.02;     ///< of the motion: what a finer mesh changes where that cannot be computed
  double worthwhile = 5.0;  ///< log evidence from which an unknown is fitted; twice this is worth an effect beside a model
                            ///< that leaves no structure
  double smallest = 1e-3;   ///< of its prior's standard deviation: smallest size that an added amplitude's prior holds
  double most_unknown = 0.2;  ///< probability of "none of these" up to which an effect is named: a wrong name costs five
                              ///< times what an abstention does
  double promising = 0.2;     ///< share of the structured error from which an effect is one of several, or is run in full
  int modes = 12;             ///< lowest modes along which the mesh's error and the test are parted
  double most_traces = 0.5;   ///< share of E's mixture that all effects without a proof may have together
};
constexpr ComparisonNumbers kComparison{};

}  // namespace tissue_stiffness
