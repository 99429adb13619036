#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/estimation/misfit_test.hpp"
#include "tissue_stiffness/fit/recording_fit.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"

namespace tissue_stiffness {

/// A comparison decides by these numbers.
struct ComparisonNumbers {
  double believed = 0.95;         ///< posterior probability that the set of explanations has to hold
  double whole_mesh = 4.0 / 3.0;  ///< of what a mesh refined once changes, at second order: one standard deviation
  double left_of_mesh = 0.5;      ///< of what a mesh refined once changes: standard deviation in directions that D lacks
  double unknown_mesh = 0.02;     ///< of the motion: what a finer mesh changes where that cannot be computed
  double worthwhile = 5.0;        ///< log evidence from which an unknown is fitted
  double smallest = 1e-3;      ///< of its prior's standard deviation: smallest size that an added amplitude's prior holds
  double most_numerics = 3.0;  ///< largest error of the numerics that is believed, in standard deviations
  double promising = 0.2;      ///< share of the structured error from which an effect is one of several, or is run in full
  int mesh_modes = 12;         ///< lowest modes along which the mesh's error is an unknown of its own
  int test_modes = 12;         ///< lowest modes along which the residual is tested
};
constexpr ComparisonNumbers kComparison{};

/// A linearisation gives a model's rows about its fit, as far as they are linear in unit normal variables u. Its columns (N
/// x k) [sigma] are those of the free parameters, each times its prior's standard deviation, and of the time steps that a
/// simulated recording is made with.
struct Linearisation {
  Eigen::MatrixXd columns;
  Eigen::Index parameters = 0;           ///< number of these columns, the first ones; the others are numerics
  Eigen::VectorXd prior;                 ///< mean of u, counted from the fit
  std::vector<Eigen::Index> amplitudes;  ///< columns of added effects' amplitudes, whose size is not known beforehand
  double log_root_weights = 0.0;         ///< sum of log sqrt(weight): a row of weight q has the noise's variance over q
};
/// Returns the sum of the logarithms of the roots of the rows' robust weights.
double log_root_weights(const RecordingFit::Rows& rows);
/// Linearises a model about its fit. `amplitudes` are given by name.
Linearisation linearise_model(const FittedModel& fitted, const std::vector<std::string>& amplitudes = {});
/// Returns the free parameters with normal priors that a model with fewer effects does not have.
std::vector<std::string> added_amplitudes(const RecordingFit& recording_fit, const RecordingFit& smaller);

/// This is a fitted model as it is compared: its residual and the rows about it.
struct Explained {
  Eigen::VectorXd error;  ///< of each row [sigma]
  Linearisation linearisation;
};
/// Returns the residual to compare. Where the time steps of a simulated recording matter to a linear model, they are fitted
/// with it. What they do to a body that rings for long is not linear in them. `far` fits them also where no tangent shows
/// them.
Explained compared_residual(const FittedModel& fitted, const std::vector<std::string>& amplitudes = {}, bool far = false);

/// An assessment is what the comparison makes of one model.
struct Assessment {
  double log_evidence = 0.0;    ///< log p(e), up to a constant that all models share
  double log_likelihood = 0.0;  ///< log p(e | u) at the most probable u, up to the constant of log_evidence
  Eigen::VectorXd left;         ///< residual at the most probable u
  /// It tests `left`, because missing physics moves the lowest modes.
  MisfitTest test;
};

/// The comparison assesses models of one recording by their residuals e at their fits. It takes all rows, in the noise's
/// stated standard deviations times the roots of their robust weights q:
///   e ~ N(J u, s I + sum_k B_k L_k B_k^T),  u ~ N(prior, I),  J = [columns, D],  s = v (1 + m) / (1 - m),
///   log p += sum log sqrt(q).
/// D is what a finer mesh changes, divided into its shares along the lowest modes and the rest. v is the mean square across
/// the lowest modes, which missing physics hardly moves, and m is that part's memory from frame to frame. Both are those of
/// the model that leaves least there. B_k L_k B_k^T, of frame k, is a displacement along the lowest modes, because the
/// mesh's error has directions that D does not hold. Its mean square is that of `left_of_mesh` times what a refinement
/// changes along each mode. The test allows for as much. No coefficient of the numerics is believed beyond `most_numerics`
/// standard deviations. The evidence is Laplace's approximation (MacKay 2003, eq. 28.10) with the numerics as further
/// unknowns. An added amplitude's prior is an even mixture of normal ones from its stated width down to `smallest` of it.
/// So an effect pays for the order of its size and not for the width that a proposal happens to state.
class ModelComparison {
 public:
  /// `mesh_change` is what a finer mesh changes of the base's rows [sigma].
  ModelComparison(const FittedModel& base, const Eigen::VectorXd& mesh_change);

  /// Replaces that change.
  void allow_for_mesh(const Eigen::VectorXd& change);
  /// Takes note of how little a residual leaves across the lowest modes, because all models share one noise.
  void note(const Eigen::VectorXd& error);
  /// Takes over the noise that another comparison of this recording has noted, where it is less.
  void note(const ModelComparison& other);
  double noise_variance() const { return noise_variance_; }         ///< s
  const Eigen::MatrixXd& mesh_directions() const { return mesh_; }  ///< D
  /// Returns the rows (N x k) in which the covariance is s I: along B_k they shrink by the root of s / (s + L_k).
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& rows) const;
  Assessment assess(const Explained& model) const;
  /// Tests a residual itself, of a model with `fitted` parameters, against the noise that is known so far.
  MisfitTest test_of(const Eigen::VectorXd& error, double fitted) const;
  /// Tests those of its rows that are `inside`, in the frames from `first` to before `last`.
  MisfitTest test_where(const Eigen::VectorXd& error, Eigen::Index first, Eigen::Index last,
                        const std::function<bool(Eigen::Index)>& inside) const;

 private:
  Eigen::VectorXd used_;  ///< 1 where a row says something, else 0
  std::vector<Eigen::Index> offsets_;
  Eigen::MatrixXd along_;      ///< rows / amplitude of each mode
  Eigen::MatrixXd mesh_;       ///< D
  Eigen::MatrixXd basis_;      ///< B, frame under frame
  Eigen::MatrixXd variances_;  ///< L, one column a frame
  double noise_variance_ = 0.0;
  double noise_level_ = MisfitTest::most_noise;  ///< v
};

struct RandomForce;

/// A hypothesis is a fitted model in the comparison, with its probability.
struct Hypothesis {
  std::vector<std::string> effects;  ///< empty: the given model
  /// It also acts on the lowest modes: something that the library does not have. Null: nothing does.
  std::shared_ptr<const RandomForce> random_force;
  double log_prior = 0.0;
  std::shared_ptr<const Explained> explained;  ///< the model
  double log_weight = 0.0;                     ///< log evidence plus log prior, up to a constant
  double z = 0.0;                              ///< of the residual's test; with a random force, of the test without it
  bool passes = false;                         ///< that test; false with a random force
  bool structured = true;                      ///< something beyond chance is left, or a random force acts
  bool superfluous = false;                    ///< another hypothesis already suffices
  double probability = 0.0;
  bool holds(const std::string& effect) const;
  /// Returns whether this one has all that the other one has and something more, while the other one leaves no structure
  /// beyond chance.
  bool superfluous_beside(const Hypothesis& other) const;
  /// Sets weight and test as `models` assess the explained model.
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
  /// evidence. Together they have no more than half, because the evidence may be that of the mesh's error.
  std::vector<Trace> traces() const;
  /// Assigns weights, tests and probabilities to all hypotheses by one likelihood.
  void assess(const ModelComparison& models);
  /// Computes probabilities from the weights. A superfluous hypothesis has none: what it has more is too small to be
  /// missing, whatever it gains. Where the most probable model does not pass its test, a random force beside it gains what
  /// that test says, or more.
  void find_probabilities();
  /// `deeper` is a comparison about the model with `effects` added. Its hypotheses take the place of those with these
  /// effects alone, and have to be assessed together with the others.
  void merge(const std::vector<std::string>& effects, const Comparison& deeper);
};

/// Returns `adequate` if the given model is within the believed set and its residual passes, `numerics` if it passes only
/// with the mesh's error allowed for. Returns `missing` if it is not in that set, named effects alone are the most probable
/// hypothesis, and what they leave passes. Otherwise it returns `unexplained`.
Verdict judge(const Comparison& comparison);

/// Returns the effects of the fewest hypotheses that hold the believed part of the probability of all that name any effect,
/// most probable first.
std::vector<std::string> believed_effects(const Comparison& comparison);

}  // namespace tissue_stiffness
