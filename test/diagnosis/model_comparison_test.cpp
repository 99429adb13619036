// These tests cover the likelihood with the mesh's error, the evidence, and what is judged from the probabilities.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "../box_model.hpp"
#include "diagnosis/hypotheses.hpp"
#include "diagnosis/missing_force.hpp"
#include "diagnosis/scores.hpp"
#include "verification/experiment.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kNoise = 1e-4;

class CleanBar : public ::testing::Test {
 protected:
  void SetUp() override {
    const ModelSettings settings =
        box_settings({"inertia: {density: 1000}",
                      "elasticity: {law: linear, poisson_ratio: 0.45, young_modulus: {prior: 20.0e3, factor: 3}}",
                      "fixed: {region: clamp}", "gravity: {acceleration: [0.5, 1, -3]}"});
    const Experiment experiment(settings, bar_mesh(), {20e3});
    recording_.frames = see_all(experiment, experiment.film(0.0, 0.02, 20), kNoise, 1);
    base_.recording_fit = std::make_unique<RecordingFit>(settings, bar_mesh(), recording_);
    const Model& model = base_.recording_fit->model();
    base_.fit = base_.recording_fit->fit(model.parameters().prior_mean(), 0.1 * model.parameters().prior_std());
    base_.rows = base_.recording_fit->rows(base_.fit.w);
  }

  Eigen::VectorXd slow() const {  // bends the bar to and fro, as missing physics does
    Eigen::VectorXd out = base_.rows.predicted;
    return out * (3.0 / std::sqrt(out.squaredNorm() / static_cast<double>(out.size())));
  }

  Recording recording_;
  FittedModel base_;
};

// Returns a model without anything to fit.
Explained rigid(const Eigen::VectorXd& error) {
  Explained out{error, {}};
  out.linearisation.columns.resize(error.size(), 0);
  return out;
}

TEST_F(CleanBar, CountsWhiteNoiseOfTheStatedSizeOnce) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  EXPECT_NEAR(models.noise_variance(), 1.0, 0.15);
  const Eigen::VectorXd& e = base_.rows.error;
  const Eigen::VectorXd more = e + 0.1 * slow();
  EXPECT_NEAR(models.assess(rigid(e)).log_evidence - models.assess(rigid(more)).log_evidence,
              0.5 * (more.squaredNorm() - e.squaredNorm()) / models.noise_variance(), 1e-6);
}

// Noise that is stated as two thirds of what it is makes no misfit: its size is read across the lowest modes.
TEST_F(CleanBar, ReadsTheNoisesSizeWhereMissingPhysicsHardlyActs) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(base_.rows.error.size());
  base_.rows.error *= 1.5;
  const ModelComparison models(base_, none);
  EXPECT_NEAR(models.noise_variance(), 2.25, 0.3);
  EXPECT_TRUE(models.assess(rigid(base_.rows.error)).test.passes());
  EXPECT_FALSE(models.assess(rigid(base_.rows.error + slow())).test.passes());
}

// What a finer mesh would change costs no more than its prior: an effect that imitates it gains next to nothing.
TEST_F(CleanBar, MarginalisesWhatAFinerMeshChanges) {
  const Eigen::VectorXd change = slow();
  const ModelComparison models(base_, change);
  const Explained here = rigid(base_.rows.error), off = rigid(base_.rows.error + change);
  EXPECT_LT(models.assess(here).log_evidence - models.assess(off).log_evidence, 4.0);
  EXPECT_GT(0.5 * (off.error.squaredNorm() - here.error.squaredNorm()), 1000.0);
  EXPECT_TRUE(models.assess(off).test.passes());
  EXPECT_FALSE(models.test_of(off.error, 1.0).passes());
}

TEST_F(CleanBar, BelievesNoNumericsBeyondThreeStandardDeviations) {
  const Eigen::VectorXd change = slow();
  const ModelComparison models(base_, change);
  const Explained far = rigid(base_.rows.error + 20.0 * change);
  EXPECT_GT(models.assess(rigid(base_.rows.error)).log_evidence - models.assess(far).log_evidence, 1e4);
  EXPECT_FALSE(models.assess(far).test.passes());
}

// One column x has the prior N(m, 1) beside white noise: the evidence is that of N(x m, s I + x x^T).
TEST_F(CleanBar, HasTheEvidenceOfALinearModel) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  const double s = models.noise_variance(), mean = -0.7;
  const Eigen::VectorXd x = 0.05 * slow();
  Explained model{base_.rows.error + 1.2 * x, {x, 1, Eigen::VectorXd::Constant(1, mean), {}, 0.0}};
  const Eigen::VectorXd r = model.error - mean * x;
  const double square = x.squaredNorm(), along = x.dot(r);
  const double expected = -0.5 * ((r.squaredNorm() - along * along / (s + square)) / s + std::log1p(square / s));
  EXPECT_NEAR(models.assess(model).log_evidence, expected, 1e-6 * std::abs(expected));
  const double before = models.assess(model).log_evidence;
  model.linearisation.log_root_weights = -12.5;  // rows that a model calls outliers are not explained for nothing
  EXPECT_NEAR(models.assess(model).log_evidence, before - 12.5, 1e-9);
}

// If an amplitude's size is not known beforehand, the evidence is the mean over priors of several widths.
TEST_F(CleanBar, MixesThePriorsOfAnAddedAmplitude) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  const double s = models.noise_variance();
  const Eigen::VectorXd x = 100.0 * slow();  // 100 times the stated width is seen at one sigma
  const Explained model{base_.rows.error + 0.002 * x, {x, 1, Eigen::VectorXd::Zero(1), {0}, 0.0}};
  const double square = x.squaredNorm(), along = x.dot(model.error);
  double sum = 0.0;
  int widths = 0;
  for (double width = 1.0; width >= kComparison.smallest; width *= 0.25, ++widths) {
    const double precision = s / (width * width) + square;
    sum += std::exp(0.5 * (along * along / s / precision - std::log(precision * width * width / s)) -
                    0.5 * along * along / s / square);
  }
  const double expected = -0.5 * model.error.squaredNorm() / s + 0.5 * along * along / s / square + std::log(sum / widths);
  EXPECT_EQ(widths, 5);
  EXPECT_NEAR(models.assess(model).log_evidence, expected, 1e-6 * std::abs(expected));
  Explained known = model;
  known.linearisation.amplitudes.clear();
  EXPECT_GT(models.assess(model).log_evidence, models.assess(known).log_evidence + 3.0);
}

TEST_F(CleanBar, SumsTheRootsOfItsRobustWeights) {
  EXPECT_NEAR(log_root_weights(base_.rows), 0.0, 2.0);
  base_.rows.used.head(10).setConstant(0.5);
  base_.rows.used.segment(10, 5).setZero();  // rows that say nothing
  EXPECT_NEAR(log_root_weights(base_.rows), 10.0 * std::log(0.5), 2.0);
}

// Returns how many frames of such rows count as one (Bartlett 1946).
double repeated_frames(const Eigen::VectorXd& rows, const std::vector<Eigen::Index>& offsets) {
  const std::size_t frames = offsets.size() - 1;
  const Eigen::Index size = offsets[1] - offsets[0];
  double out = 1.0;
  for (std::size_t lag = 1; lag < frames; ++lag) {
    double product = 0.0;
    for (std::size_t k = lag; k < frames; ++k)
      product += rows.segment(offsets[k], size).dot(rows.segment(offsets[k - lag], size));
    out += 2.0 * std::pow(product / rows.squaredNorm(), 2);
  }
  return out;
}

// The mesh's error along a mode has other courses in time than the change of a refinement. A displacement of half its mean
// square is expected, and it lasts as that change does. Evidence and test allow for it.
TEST_F(CleanBar, AllowsForMeshErrorsThatARefinementDoesNotShow) {
  const Eigen::VectorXd change =
      ModelComparison(base_, slow()).mesh_directions().col(0) / kComparison.whole_mesh;  // along the lowest mode
  const ModelComparison models(base_, change);
  Eigen::VectorXd reversed = change;
  const std::vector<Eigen::Index>& offsets = base_.rows.offsets;
  const std::size_t frames = offsets.size() - 1;
  for (std::size_t k = 0; k < frames; ++k) {
    const Eigen::Index size = offsets[k + 1] - offsets[k];
    reversed.segment(offsets[k], size) = change.segment(offsets[frames - 1 - k], size);
  }
  // Here C = s I + b R^2 P, where R^2 is the mean square of a frame, and b such frames count as one. For x along the modes,
  // x^T C^-1 x = |x|^2 / (s + b R^2).
  const double s = models.noise_variance(), share = kComparison.left_of_mesh, repeated = repeated_frames(change, offsets);
  EXPECT_GT(repeated, 3.0);
  const double room = repeated * share * share * change.squaredNorm() / static_cast<double>(frames);
  EXPECT_NEAR(models.whitened(reversed).squaredNorm() / s, reversed.squaredNorm() / (s + room),
              0.1 * reversed.squaredNorm() / (s + room));
  const auto loss = [&, before = models.assess(rigid(base_.rows.error)).log_evidence](double times) {
    return before - models.assess(rigid(base_.rows.error + times * share * reversed)).log_evidence;
  };
  const double expected = 0.5 * share * share * reversed.squaredNorm() / (s + room);
  EXPECT_NEAR(loss(1.0), expected, 0.3 * expected);
  EXPECT_NEAR(loss(12.0), 144.0 * expected, 0.2 * 144.0 * expected);
  EXPECT_TRUE(models.assess(rigid(base_.rows.error + share * reversed)).test.passes());
  EXPECT_FALSE(models.assess(rigid(base_.rows.error + 12.0 * share * reversed)).test.passes());
}

TEST(ComparisonNumbers, AreThoseOfTheMethodsTable) {
  std::ifstream file(std::string(TISSUE_STIFFNESS_SOURCE_DIR) + "/doc/method/decision_rule.md");
  const std::string page((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  ASSERT_FALSE(page.empty());
  const auto row = [&](const std::string& names, const std::string& value) {
    EXPECT_NE(page.find("| " + names + " | " + value + " |"), std::string::npos) << names << " " << value;
  };
  const auto text = [](double value) {
    std::ostringstream out;
    out << value;
    return out.str();
  };
  row("`believed`", text(kComparison.believed));
  row("`whole_mesh`", text(3.0 * kComparison.whole_mesh) + "/3");
  row("`left_of_mesh`", text(kComparison.left_of_mesh));
  row("`unknown_mesh`", text(kComparison.unknown_mesh));
  row("`worthwhile`", text(kComparison.worthwhile));
  row("`smallest`", text(kComparison.smallest));
  row("`promising`", text(kComparison.promising));
  row("`most_numerics`", text(kComparison.most_numerics));
  row("`modes`", text(kComparison.modes));
  row("`most_traces`", text(kComparison.most_traces));
  row("`bound`", text(MisfitTest::bound));
  row("`tolerated`", text(MisfitTest::tolerated));
  row("`most_noise`", text(MisfitTest::most_noise));
  row("`beyond_chance`", text(MisfitTest::beyond_chance));
}

// `random_force` adds one that does nothing.
Hypothesis hypothesis(std::vector<std::string> effects, double weight, bool passes, bool random_force = false) {
  Hypothesis out;
  out.effects = std::move(effects);
  if (random_force) out.random_force = std::make_shared<const RandomForce>();
  out.log_weight = weight;
  out.passes = passes;
  out.z = passes ? 0.0 : 1e3;
  return out;
}

Comparison compared(std::vector<Hypothesis> hypotheses) {
  Comparison out;
  out.passes_without_mesh = hypotheses.front().passes;
  out.hypotheses = std::move(hypotheses);
  out.find_probabilities();
  return out;
}

// A residual that resembles noise of twice the level is a misfit once another model has shown how little noise there is.
TEST_F(CleanBar, TestsAllModelsAgainstTheSameNoise) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  const Eigen::VectorXd loud = 2.0 * base_.rows.error;
  EXPECT_FALSE(models.test_of(loud, 1.0).passes());
  EXPECT_NEAR(models.test_of(loud, 1.0).noise_level(), 1.0, 0.05);
  MisfitTest own = models.test_of(loud, 1.0);
  own.set_noise(MisfitTest::most_noise);
  EXPECT_NEAR(own.noise_level(), 4.0, 0.2);
  EXPECT_TRUE(own.passes());
}

// A model that lacks something moves otherwise than the body, and so does what a finer mesh changes of it.
TEST_F(CleanBar, TakesTheErrorOfTheMeshFromTheCloserBase) {
  const Eigen::VectorXd large = slow(), small = 0.01 * slow();
  const ModelComparison close(base_, small);
  base_.rows.error += slow();
  const ModelComparison far(base_, large);
  base_.rows.error *= 0.5;
  const ModelComparison quiet(base_, large);
  for (const ModelComparison& both : {common_likelihood(close, far), common_likelihood(far, close)}) {
    EXPECT_EQ(both.mesh_directions(), close.mesh_directions());
    EXPECT_EQ(both.noise_variance(), std::min(close.noise_variance(), far.noise_variance()));
  }
  EXPECT_EQ(common_likelihood(far, quiet).noise_variance(), quiet.noise_variance());
  EXPECT_EQ(common_likelihood(quiet, far).base_cost(), quiet.base_cost());
}

// Hypotheses of several rounds are weighed by one likelihood.
TEST_F(CleanBar, AssessesAllHypothesesAlike) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  Comparison c;
  for (const double wrong : {0.0, 0.1, 1.0}) {
    Hypothesis h = hypothesis(wrong > 0.0 ? std::vector<std::string>{"a"} : std::vector<std::string>{}, 1e9, false);
    h.explained = std::make_shared<const Explained>(rigid(base_.rows.error + wrong * slow()));
    h.log_prior = -1.5;
    c.hypotheses.push_back(std::move(h));
  }
  c.assess(models);
  EXPECT_FALSE(c.given().structured);
  for (const Hypothesis& h : c.hypotheses) {
    const Assessment own = models.assess(*h.explained);
    EXPECT_DOUBLE_EQ(h.log_weight, own.log_evidence - 1.5);
    EXPECT_DOUBLE_EQ(h.z, own.test.z());
    EXPECT_EQ(h.passes, own.test.passes());
  }
  EXPECT_GT(c.given().probability, 0.99);
}

// A pair that was fitted in both orders is one hypothesis, and the likelier fit stands for it.
TEST_F(CleanBar, ComparesASetOfEffectsOnce) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  Comparison c;
  const auto add = [&](std::vector<std::string> effects, double wrong) {
    c.hypotheses.push_back(hypothesis(std::move(effects), 0.0, false));
    c.hypotheses.back().explained = std::make_shared<const Explained>(rigid(base_.rows.error + wrong * slow()));
  };
  add({}, 1.0);
  add({"a", "b"}, 0.2);
  add({"a", "c"}, 0.1);
  add({"b", "a"}, 0.1);
  c.assess(models);
  ASSERT_EQ(c.hypotheses.size(), 3u);
  EXPECT_TRUE(c.given().effects.empty());
  EXPECT_EQ(c.hypotheses[1].effects, (std::vector<std::string>{"a", "c"}));
  EXPECT_EQ(c.hypotheses[2].effects, (std::vector<std::string>{"b", "a"}));
  EXPECT_NEAR(c.probability_of("a"), 1.0, 1e-9);
  EXPECT_NEAR(c.probability_of("b"), 0.5, 1e-9);
}

// A slow bending that nothing explains is the work of a force; noise is not.
TEST_F(CleanBar, GivesARandomForceWhatNothingElseExplains) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  const RandomForce force(base_);
  EXPECT_LT(log_evidence_gained(force, models.assess(rigid(base_.rows.error)), models), 0.0);
  const Assessment bent = models.assess(rigid(base_.rows.error + slow()));
  const double gain = log_evidence_gained(force, bent, models);
  EXPECT_GT(gain, 0.3 * 0.5 * slow().squaredNorm());
  EXPECT_LT(gain, 0.5 * bent.left.squaredNorm() / models.noise_variance());
}

TEST(Comparison, HasProbabilitiesInTheRatioOfTheEvidence) {
  const Comparison c = compared({hypothesis({}, -1e5, true), hypothesis({"a"}, -1e5 + std::log(3.0), true),
                                 hypothesis({"b"}, -2e5, true), hypothesis({}, -1e5, false, true)});
  EXPECT_NEAR(c.given().probability, 0.2, 1e-9);
  EXPECT_NEAR(c.probability_of("a"), 0.6, 1e-9);
  EXPECT_EQ(c.probability_of("b"), 0.0);
  EXPECT_NEAR(c.none_of_these(), 0.2, 1e-9);
  EXPECT_EQ(c.best().effects, std::vector<std::string>{"a"});
}

// What was compared about the model with `a` takes the place of what was known of that model.
TEST(Comparison, MergesWhatIsFoundBesideALeader) {
  Comparison c = compared({hypothesis({}, 0.0, false), hypothesis({"a"}, 50.0, false), hypothesis({"b"}, 40.0, false),
                           hypothesis({"a"}, 70.0, false, true), hypothesis({}, 60.0, false, true)});
  c.hypotheses[1].log_prior = -2.0;
  EXPECT_EQ(judge(c), Verdict::unexplained);
  Comparison deeper = compared({hypothesis({}, 51.0, false), hypothesis({"b"}, 81.0, true), hypothesis({"c"}, 80.0, true),
                                hypothesis({}, 65.0, false, true)});
  deeper.hypotheses[1].log_prior = -3.0;
  c.merge({"a"}, deeper);
  c.find_probabilities();
  ASSERT_EQ(c.hypotheses.size(), 7u);
  EXPECT_TRUE(c.given().effects.empty());
  EXPECT_EQ(c.best().effects, (std::vector<std::string>{"a", "b"}));
  EXPECT_DOUBLE_EQ(c.best().log_prior, -5.0);
  EXPECT_NEAR(c.probability_of("a"), 1.0, 1e-5);
  EXPECT_NEAR(c.probability_of("b"), 1.0 / (1.0 + std::exp(-1.0)), 1e-5);
  EXPECT_LT(c.none_of_these(), 1e-4);
  EXPECT_EQ(judge(c), Verdict::missing);
  EXPECT_EQ(believed_effects(c), (std::vector<std::string>{"a", "b", "c"}));
}

// Something unknown is one alternative, however many models it was tried beside.
TEST(Comparison, MakesNoneOfTheseNoLikelierByTryingMoreModels) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, false), hypothesis({"a"}, 500.0, true),
                               hypothesis({"a"}, 900.0, false, true)};
  list[1].z = 2.6;
  const double none = std::exp(log_bayes_factor_bound(2.6));
  EXPECT_NEAR(compared(list).none_of_these(), none / (1.0 + none), 1e-9);
  for (const char* const other : {"b", "c", "d"}) list.push_back(hypothesis({other}, 900.0, false, true));
  EXPECT_NEAR(compared(list).none_of_these(), none / (1.0 + none), 1e-9);
  EXPECT_NEAR(compared(list).probability_of("a"), 1.0 / (1.0 + none), 1e-9);
}

// What is added to a model that leaves nothing but noise is too small to be missing, whatever it gains.
TEST(Comparison, GivesNothingToWhatExtendsASufficientModel) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, true), hypothesis({"a"}, 50.0, true), hypothesis({"b"}, 49.0, true),
                               hypothesis({"a", "b"}, 90.0, true), hypothesis({"a"}, 60.0, false, true)};
  list[1].structured = false;
  Comparison c = compared(list);
  EXPECT_NEAR(c.probability_of("a"), 1.0 / (1.0 + std::exp(-1.0)), 1e-9);
  EXPECT_EQ(c.none_of_these(), 0.0);
  EXPECT_DOUBLE_EQ(c.hypotheses[3].log_weight, 90.0);
  EXPECT_EQ(judge(c), Verdict::missing);
  EXPECT_EQ(believed_effects(c), (std::vector<std::string>{"a", "b"}));  // each of them alone
  EXPECT_LT(c.hypotheses[2].probability, 1.0);
  c.hypotheses[0].structured = false;
  c.find_probabilities();
  EXPECT_EQ(c.given().probability, 1.0);
  EXPECT_EQ(judge(c), Verdict::adequate);
}

// Evidence from across the lowest modes counts no more than what the residual of the smaller model shows.
TEST(Comparison, TakesNoMoreEvidenceThanTheResidualShows) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, true), hypothesis({"a"}, 500.0, true), hypothesis({"b"}, 499.0, true)};
  list[0].structure = 2.0;
  const Comparison slight = compared(list);
  const double given = std::exp(-log_bayes_factor_bound(2.0)), both = 1.0 + std::exp(-1.0);
  EXPECT_NEAR(slight.given().probability, given / (given + both), 1e-9);
  EXPECT_NEAR(slight.probability_of("a") / slight.probability_of("b"), std::exp(1.0), 1e-9);
  EXPECT_EQ(judge(slight), Verdict::adequate);
  list[0].structure = 4.0;
  EXPECT_EQ(judge(compared(list)), Verdict::missing);
  list[1].log_weight = list[2].log_weight = 1.0;  // less than that is not raised
  EXPECT_NEAR(compared(list).given().probability, 1.0 / (1.0 + 2.0 * std::exp(1.0)), 1e-9);
}

// The evidence of what is superfluous still counts for E, but no more than the test that does without it.
TEST(Comparison, TracesWhatMayActWithoutBeingMissed) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, true), hypothesis({"a"}, 2000.0, true), hypothesis({"b"}, 1999.0, true),
                               hypothesis({"c"}, 5000.0, false, true)};
  list[0].structured = false;
  const Comparison strong = compared(list);
  const std::vector<Trace> halves = strong.traces();
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_EQ(halves[0].hypothesis->effects, std::vector<std::string>{"a"});
  EXPECT_NEAR(halves[0].share, 0.5 / (1.0 + std::exp(-1.0)), 1e-9);
  EXPECT_NEAR(halves[0].share + halves[1].share, 0.5, 1e-9);
  list[1].log_weight = list[2].log_weight = -2.0;
  const Comparison weak = compared(list);
  EXPECT_NEAR(weak.traces()[0].share, 1.0 / (2.0 + std::exp(2.0)), 1e-9);
  list[0].structured = true;
  EXPECT_TRUE(compared(list).traces().empty());
}

// The most probable model decides by its own test whether something unknown acts beside it, or beside another model.
TEST(Comparison, GivesToSomethingUnknownWhatTheTestSays) {
  const auto none_of_these = [](double z, bool passes, double evidence) {
    std::vector<Hypothesis> list{hypothesis({}, 0.0, false), hypothesis({"a"}, 50.0, passes), hypothesis({"b"}, 20.0, true),
                                 hypothesis({}, 0.0, false, true), hypothesis({"a"}, evidence, false, true)};
    list[1].z = z;
    for (const std::size_t i : {3, 4}) list[i].log_prior = list[i].log_prior_of_force = -3.0;
    return compared(list).none_of_these();
  };
  for (const double evidence : {20.0, 500.0}) {
    EXPECT_NEAR(none_of_these(-5.0, true, evidence), 1.0 / (1.0 + std::exp(3.0)), 1e-6);
    EXPECT_LT(none_of_these(2.9, true, evidence), 0.8);
    EXPECT_NEAR(none_of_these(3.5, false, evidence), 1.0 / (1.0 + std::exp(3.0 - log_bayes_factor_bound(3.5))), 1e-6);
    EXPECT_GT(none_of_these(7.0, false, evidence), 0.999);
  }
}

TEST(Comparison, ToleratesOfSomethingUnknownWhatTheTestTolerates) {
  const auto verdict = [](double given_z, double force_beside_given) {
    std::vector<Hypothesis> list{hypothesis({}, 0.0, given_z <= 3.0), hypothesis({"a"}, 50.0, true),
                                 hypothesis({}, force_beside_given, false, true)};
    list[0].z = given_z;
    for (std::size_t i = 1; i < list.size(); ++i) list[i].log_prior = -3.0;
    list[2].log_prior_of_force = -3.0;
    return judge(compared(list));
  };
  EXPECT_EQ(verdict(1.0, 500.0), Verdict::adequate);  // the effect explains only a part of what the test tolerates
  EXPECT_EQ(verdict(1.0, 20.0), Verdict::missing);
  EXPECT_EQ(verdict(100.0, 500.0), Verdict::missing);  // what is left beside the effect is tolerated
}

TEST(Judge, NeedsBothAProbabilityAndAFit) {
  const auto verdict = [](double given, bool given_passes, double named, bool named_passes, double none) {
    return judge(compared({hypothesis({}, std::log(given), given_passes), hypothesis({"a"}, std::log(named), named_passes),
                           hypothesis({}, std::log(none), false, true)}));
  };
  EXPECT_EQ(verdict(0.9, true, 0.1, true, 0.0), Verdict::adequate);
  EXPECT_EQ(verdict(0.1, true, 0.9, true, 0.0), Verdict::adequate);  // it is within the believed set
  EXPECT_EQ(verdict(0.01, true, 0.99, true, 0.0), Verdict::missing);
  EXPECT_EQ(verdict(0.0, false, 1.0, false, 0.0), Verdict::unexplained);
  EXPECT_EQ(verdict(1.0, false, 0.0, true, 0.0), Verdict::unexplained);
  // An effect that barely passes does not explain a recording in which something unknown is as probable beforehand.
  std::vector<Hypothesis> barely{hypothesis({}, 0.0, false), hypothesis({"a"}, 50.0, true),
                                 hypothesis({"a"}, 60.0, false, true)};
  barely[1].z = 2.9;
  EXPECT_EQ(judge(compared(barely)), Verdict::unexplained);
  // Nor does one of several explanations in which something unknown acts, if these are more probable together.
  std::vector<Hypothesis> several{hypothesis({}, 0.0, false), hypothesis({"a"}, 50.0, true),
                                  hypothesis({}, 60.0, false, true), hypothesis({"b"}, 60.0, false, true)};
  several[1].z = 1.3;
  several[2].log_prior_of_force = several[3].log_prior_of_force = 0.3 - log_bayes_factor_bound(1.3);
  EXPECT_EQ(compared(several).best().effects, std::vector<std::string>{"a"});
  EXPECT_NEAR(compared(several).none_of_these(), 1.0 / (1.0 + std::exp(-0.3)), 1e-9);
  EXPECT_EQ(judge(compared(several)), Verdict::unexplained);
  EXPECT_EQ(judge(compared({hypothesis({}, 0.0, true), hypothesis({"a"}, 50.0, true)})), Verdict::missing);
  Comparison mesh = compared({hypothesis({}, 0.0, true)});
  mesh.passes_without_mesh = false;
  EXPECT_EQ(judge(mesh), Verdict::numerics);
}

}  // namespace
}  // namespace tissue_stiffness
