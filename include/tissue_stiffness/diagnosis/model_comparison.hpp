#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/estimation/misfit_test.hpp"

namespace tissue_stiffness {

/// The numbers that a comparison decides by.
struct ComparisonNumbers {
  double believed = 0.95;         ///< posterior probability that the set of explanations holds
  double whole_mesh = 4.0 / 3.0;  ///< of what a mesh refined once changes, at second order: one standard deviation
  double left_of_mesh = 0.5;      ///< of what a mesh refined once changes: standard deviation in directions that D lacks
  double unknown_mesh = 0.02;     ///< of the motion: what a finer mesh changes where that cannot be computed
  double worthwhile = 5.0;        ///< log evidence from which on an unknown is fitted
  double smallest = 1e-3;      ///< of its prior's standard deviation: what an added effect's normal amplitude may be, too
  double most_numerics = 3.0;  ///< standard deviations of an error of the numerics
  double promising = 0.2;      ///< share of the structured error from which on an effect is one of several, or run in full
  int mesh_modes = 12;         ///< lowest modes along which the mesh's error is an unknown of its own
  int test_modes = 12;         ///< lowest modes that the test of the residual looks along
};
constexpr ComparisonNumbers kComparison{};

/// A model's rows about its fit, as far as they are linear in unit normal variables u: columns (N x k) [sigma] of its free
/// parameters, each times its prior's standard deviation, and of the time steps that a simulated recording is made with.
struct Linearisation {
  Eigen::MatrixXd columns;
  Eigen::Index parameters = 0;           ///< the first of them; the others are numerics
  Eigen::VectorXd prior;                 ///< mean of u, counted from the fit
  std::vector<Eigen::Index> amplitudes;  ///< of the columns: added effects', whose size is not known beforehand
  double log_root_weights = 0.0;         ///< sum of log sqrt(weight): a row of weight q has the noise's variance over q
};
/// Sum of the logarithms of the roots of the rows' robust weights.
double log_root_weights(const Study::Rows& rows);
/// `amplitudes`: by name.
Linearisation linearise(const Fitted& fitted, const std::vector<std::string>& amplitudes = {});
/// Free parameters with normal priors that a model with fewer effects does not have.
std::vector<std::string> added_amplitudes(const Study& study, const Study& smaller);

/// A fitted model as it is compared: its residual and the rows about it.
struct Explained {
  Eigen::VectorXd error;  ///< of each row [sigma]
  Linearisation linearisation;
};
/// Where the time steps of a simulated recording matter to a linear model they are fitted with it: what they do to a body
/// that rings for long is not linear in them. `far`: also where no tangent shows it.
Explained explain(const Fitted& fitted, const std::vector<std::string>& amplitudes = {}, bool far = false);

/// What the comparison makes of one model.
struct Assessment {
  double log_evidence = 0.0;    ///< log p(e), but for a constant that all models share
  double log_likelihood = 0.0;  ///< log p(e | u) at the most probable u; but for the same constant
  Eigen::VectorXd left;         ///< of the residual at the most probable u
  /// Of what that leaves: missing physics moves the lowest modes.
  MisfitTest test;
};

/// Compares models of one recording by their residuals e at their fits, over all rows, in the noise's stated standard
/// deviations times the roots of their robust weights q:
///   e ~ N(J u, s I + sum_k B_k L_k B_k^T),  u ~ N(prior, I),  J = [columns, D],  s = v (1 + m) / (1 - m),
///   log p += sum log sqrt(q).
/// D: what a finer mesh changes, parted into its shares along the lowest modes and the rest. v: mean square across the
/// lowest modes, which missing physics hardly moves, and m: that part's memory from frame to frame; both are those of the
/// model that leaves least there. B_k L_k B_k^T, of frame k: a displacement along the lowest modes, whose mean square is
/// that of `left_of_mesh` times what a refinement changes along each: the mesh's error has directions that D does not hold.
/// The test allows for as much. No coefficient of the numerics is believed beyond `most_numerics` standard deviations.
/// Laplace's approximation of the evidence (MacKay 2003, eq. 28.10) with the numerics as further unknowns. An added
/// amplitude's prior is a mixture of normal ones from its stated width down to `smallest` of it, alike: an effect pays for
/// the order of its size and not for the width that a proposal happens to state.
class ModelComparison {
 public:
  /// `mesh_change`: what a finer mesh changes of the base's rows [sigma].
  ModelComparison(const Fitted& base, const Eigen::VectorXd& mesh_change);

  /// Replaces that change.
  void allow_for_mesh(const Eigen::VectorXd& change);
  /// Takes note of how little a residual leaves across the lowest modes: the noise is the same for all models.
  void note(const Eigen::VectorXd& error);
  /// Takes over less noise that another comparison of the same recording has noted.
  void note(const ModelComparison& other);
  double noise_variance() const { return noise_variance_; }         ///< s
  const Eigen::MatrixXd& mesh_directions() const { return mesh_; }  ///< D
  /// Rows (N x k) in which the covariance is s I: along B_k they shrink by the root of s / (s + L_k).
  Eigen::MatrixXd whitened(const Eigen::MatrixXd& rows) const;
  Assessment assess(const Explained& model) const;
  /// The test of a residual itself, of a model with that many parameters, against the noise that is known so far.
  MisfitTest test_of(const Eigen::VectorXd& error, double fitted) const;
  /// The same of those rows in the frames from `first` to before `last`.
  MisfitTest test_where(const Eigen::VectorXd& error, Eigen::Index first, Eigen::Index last,
                        const std::function<bool(Eigen::Index)>& inside) const;

 private:
  Eigen::VectorXd used_;  ///< 1 where a row says something, else 0
  std::vector<Eigen::Index> offsets_;
  Eigen::MatrixXd along_;      ///< rows / amplitude of each mode
  Eigen::MatrixXd mesh_;       ///< D
  Eigen::MatrixXd basis_;      ///< B, frame under frame
  Eigen::MatrixXd variances_;  ///< L of each frame, a column each
  double noise_variance_ = 0.0;
  double noise_level_ = MisfitTest::most_noise;  ///< v
};

struct RandomForce;

/// One hypothesis after the comparison.
struct Hypothesis {
  std::vector<std::string> effects;  ///< empty: the given model
  /// Acts on the lowest modes besides: something that the library does not have. Null: nothing does.
  std::shared_ptr<const RandomForce> random_force;
  double log_prior = 0.0;
  std::shared_ptr<const Explained> explained;  ///< the model
  double log_weight = 0.0;                     ///< log evidence and log prior, but for a constant
  double z = 0.0;                              ///< of the residual's test; of a random force's it is that without the force
  bool passes = false;                         ///< that test
  bool structured = true;                      ///< something beyond chance is left, or a random force acts
  bool superfluous = false;                    ///< beside another hypothesis
  double probability = 0.0;
  bool holds(const std::string& effect) const;
  /// It has all that the other one has, which leaves no structure beyond chance, and something more.
  bool superfluous_beside(const Hypothesis& other) const;
  /// Weight and test as these models assess the explained one.
  void weigh(const Assessment& assessment, const ModelComparison& models);
};
/// A hypothesis that no test asks for, and its share of the belief where its evidence counts all the same.
struct Trace {
  const Hypothesis* hypothesis;
  double share;
};
struct Comparison {
  bool passes_without_mesh = false;    ///< the given model's residual, with the error of the mesh in it
  std::vector<Hypothesis> hypotheses;  ///< the given model first

  const Hypothesis& given() const { return hypotheses.front(); }
  const Hypothesis& best() const;                          ///< the most probable one
  double none_of_these() const;                            ///< probability of all hypotheses with a random force
  double probability_of(const std::string& effect) const;  ///< of all others that hold it
  /// What may act beside the most probable hypothesis without being missed: extensions of it that are superfluous, by their
  /// evidence. Together they have no more than half, because the evidence may be that of the mesh's error.
  std::vector<Trace> traces() const;
  /// Weights, tests and probabilities of all hypotheses by one likelihood.
  void assess(const ModelComparison& models);
  /// From the weights. What is superfluous has none: what it has more is too small to be missing, whatever it gains. Where
  /// the most probable model does not pass its test a random force beside it gains what that test says, or more.
  void find_probabilities();
  /// `deeper`: about the model with `effects` added. Its hypotheses take the place of those with these effects alone, and
  /// are to be assessed together with the others.
  void merge(const std::vector<std::string>& effects, const Comparison& deeper);
};

enum class Verdict { adequate, missing, numerics, unexplained };
/// `adequate`: the given model is within the believed set and its residual passes.
/// `numerics`: it passes only beside the mesh's error. `missing`: it is not in that set, named effects alone are the most
/// probable hypothesis, and what they leave passes. Otherwise `unexplained`.
Verdict judge(const Comparison& comparison);

/// Effects of the fewest hypotheses that hold the believed part of the probability of all that name any, most probable
/// first.
std::vector<std::string> believed_effects(const Comparison& comparison);

}  // namespace tissue_stiffness
