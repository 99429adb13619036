// The probabilities of hypotheses, and what is judged from them.
#include "diagnosis/hypotheses.hpp"

#include <cmath>
#include <utility>

#include "clean_bar.hpp"
#include "diagnosis/missing_force.hpp"
#include "diagnosis/scores.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLeavesNoise = 0.0;  // z of what leaves noise alone
constexpr double kPasses = 2.0;       // of what passes, and yet leaves some structure
constexpr double kFails = 1e3;        // of what shows whatever others gain

// Models have the same modal evidence here, and `random_force` adds one that gains nothing along the modes. So only the
// tests say what is left.
Hypothesis hypothesis(std::vector<std::string> effects, double evidence, double z, bool random_force = false) {
  Hypothesis out;
  out.effects = std::move(effects);
  if (random_force) out.random_force = std::make_shared<const RandomForce>();
  out.log_modal_evidence = Eigen::Vector2d::Constant(random_force ? -1e3 : 0.0);
  out.log_evidence = evidence;
  out.test.z = z;
  return out;
}

Comparison compared(std::vector<Hypothesis> hypotheses) {
  Comparison out;
  out.passes_without_mesh = hypotheses.front().test.passes();
  out.hypotheses = std::move(hypotheses);
  out.find_probabilities();
  return out;
}

// Hypotheses of several rounds are weighed by one likelihood.
TEST_F(CleanBar, AssessesAllHypothesesAlike) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  Comparison c;
  for (const double wrong : {0.0, 0.1, 1.0}) {
    Hypothesis h = hypothesis(wrong > 0.0 ? std::vector<std::string>{"a"} : std::vector<std::string>{}, 1e9, kFails);
    h.explained = std::make_shared<const Explained>(rigid(base_.rows.error + wrong * slow()));
    h.log_prior = -1.5;
    c.hypotheses.push_back(std::move(h));
  }
  c.assess(models);
  EXPECT_FALSE(c.given().test.structured());
  for (const Hypothesis& h : c.hypotheses) {
    const Assessment own = models.assess(*h.explained);
    EXPECT_DOUBLE_EQ(h.log_evidence, own.log_evidence);
    EXPECT_EQ(h.log_modal_evidence, own.log_modal_evidence);
    EXPECT_DOUBLE_EQ(h.test.z, own.test.z);
  }
  EXPECT_GT(c.given().probability, 0.99);
}

// A pair that was fitted in both orders is one hypothesis, and the likelier fit stands for it.
TEST_F(CleanBar, ComparesASetOfEffectsOnce) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  Comparison c;
  const auto add = [&](std::vector<std::string> effects, double wrong) {
    c.hypotheses.push_back(hypothesis(std::move(effects), 0.0, kFails));
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

TEST(Comparison, HasProbabilitiesInTheRatioOfTheEvidence) {
  const Comparison c = compared({hypothesis({}, -1e5, kFails), hypothesis({"a"}, -1e5 + std::log(3.0), kLeavesNoise),
                                 hypothesis({"b"}, -2e5, kLeavesNoise), hypothesis({}, -1e5, kFails, true)});
  EXPECT_NEAR(c.given().probability, 0.2, 1e-9);
  EXPECT_NEAR(c.probability_of("a"), 0.6, 1e-9);
  EXPECT_EQ(c.probability_of("b"), 0.0);
  EXPECT_NEAR(c.none_of_these(), 0.2, 1e-9);
  EXPECT_EQ(c.best().effects, std::vector<std::string>{"a"});
}

// What was compared about the model with `a` takes the place of what was known of that model.
TEST(Comparison, MergesWhatIsFoundBesideALeader) {
  Comparison c = compared({hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, kFails), hypothesis({"b"}, 40.0, kFails),
                           hypothesis({"a"}, 70.0, kFails, true), hypothesis({}, 60.0, kFails, true)});
  c.hypotheses[1].log_prior = -2.0;
  EXPECT_EQ(judge(c), Verdict::unexplained);
  Comparison deeper = compared({hypothesis({}, 51.0, kFails), hypothesis({"b"}, 84.0, kLeavesNoise),
                                hypothesis({"c"}, 80.0, kLeavesNoise), hypothesis({}, 65.0, kFails, true)});
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
  std::vector<Hypothesis> list{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 500.0, 2.6),
                               hypothesis({"a"}, 900.0, kFails, true)};
  const double none = std::exp(log_bayes_factor_of_test(2.6));
  EXPECT_NEAR(compared(list).none_of_these(), none / (1.0 + none), 1e-9);
  for (const char* const other : {"b", "c", "d"}) list.push_back(hypothesis({other}, 900.0, kFails, true));
  EXPECT_NEAR(compared(list).none_of_these(), none / (1.0 + none), 1e-9);
  EXPECT_NEAR(compared(list).probability_of("a"), 1.0 / (1.0 + none), 1e-9);
}

// Nothing is missing as long as the mesh's error may explain the residual.
TEST(Comparison, GivesTheGivenModelTheErrorOfTheMesh) {
  Comparison c = compared(
      {hypothesis({}, 0.0, kLeavesNoise), hypothesis({"a"}, 50.0, kLeavesNoise), hypothesis({}, 80.0, kFails, true)});
  c.passes_without_mesh = false;
  EXPECT_EQ(c.given().probability, 1.0);
  EXPECT_EQ(judge(c), Verdict::numerics);
}

// Something unknown may act beside a named effect wherever the test leaves structure. Elsewhere it may act in that effect's
// place, and keeps at least half of its prior.
TEST(Comparison, AsksTheTestForSomethingUnknownBesideANamedEffect) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, 2.97),
                               hypothesis({"a"}, 90.0, kFails, true)};
  list[2].log_prior_of_force = -3.0;
  const double none = std::exp(log_bayes_factor_of_test(2.97) - 3.0);
  EXPECT_NEAR(compared(list).none_of_these(), none / (1.0 + none), 1e-9);
  list[1].test.z = 2.6;
  EXPECT_NEAR(compared(list).none_of_these(), 0.264, 0.005);
  EXPECT_EQ(judge(compared(list)), Verdict::unexplained) << "a wrong name costs more than an abstention";
  list[1].test.z = 2.0;
  EXPECT_NEAR(compared(list).none_of_these(), 0.120, 0.005);
  EXPECT_EQ(judge(compared(list)), Verdict::missing);
  list[1].test.z = -20.0;
  EXPECT_NEAR(compared(list).none_of_these(), 0.5 / (0.5 + std::exp(3.0)), 1e-9);
  EXPECT_EQ(judge(compared(list)), Verdict::missing);
  list[0].test.z = kLeavesNoise;
  EXPECT_EQ(compared(list).none_of_these(), 0.0) << "the given model suffices, so nothing is named";
}

// What is added to a model that leaves nothing but noise is too small to be missing, whatever it gains.
TEST(Comparison, GivesNothingToWhatExtendsASufficientModel) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, kLeavesNoise),
                               hypothesis({"b"}, 49.0, kPasses), hypothesis({"a", "b"}, 90.0, kPasses),
                               hypothesis({"a"}, 60.0, kFails, true)};
  list[4].log_prior_of_force = -3.0;
  Comparison c = compared(list);
  const double none = std::exp(log_bayes_factor_of_test(kLeavesNoise) - 3.0), all = 1.0 + std::exp(-1.0) + none;
  EXPECT_NEAR(c.probability_of("a"), 1.0 / all, 1e-9);
  EXPECT_NEAR(c.none_of_these(), none / all, 1e-9) << "in the place of a, and not beside it";
  EXPECT_DOUBLE_EQ(c.hypotheses[3].log_evidence, 90.0);
  EXPECT_EQ(judge(c), Verdict::missing);
  EXPECT_EQ(believed_effects(c), (std::vector<std::string>{"a", "b"}));  // each of them alone
  EXPECT_LT(c.hypotheses[2].probability, 1.0);
  c.hypotheses[0].test.z = kLeavesNoise;
  c.passes_without_mesh = true;
  c.find_probabilities();
  EXPECT_EQ(c.given().probability, 1.0);
  EXPECT_EQ(judge(c), Verdict::adequate);
}

// Evidence from across the lowest modes counts no more than what the residual of the smaller model shows.
TEST(Comparison, TakesNoMoreEvidenceThanTheResidualShows) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, 2.0), hypothesis({"a"}, 500.0, kLeavesNoise),
                               hypothesis({"b"}, 499.0, kLeavesNoise)};
  const Comparison slight = compared(list);
  const double gain = std::exp(log_bayes_factor_of_test(2.0));
  EXPECT_NEAR(slight.given().probability, 1.0 / (1.0 + 2.0 * gain), 1e-9);
  EXPECT_NEAR(slight.probability_of("a"), slight.probability_of("b"), 1e-9) << "the mesh's error may tell them apart";
  EXPECT_EQ(judge(slight), Verdict::adequate);
  list[0].test.z = 4.0;
  EXPECT_EQ(judge(compared(list)), Verdict::missing);
  list[1].log_evidence = list[2].log_evidence = 1.0;  // less than that is not raised
  EXPECT_NEAR(compared(list).given().probability, 1.0 / (1.0 + 2.0 * std::exp(1.0)), 1e-9);
}

// A small effect may lie along few directions, which a test of all squares together does not see. Where the modal evidence
// shows it, it is missing though the test passes. It has to explain the other rows as well.
TEST(Comparison, BelievesWhatTheLowestModesShowThoughTheTestPasses) {
  const auto list = [](double whole, double modal) {
    std::vector<Hypothesis> out{hypothesis({}, 0.0, kLeavesNoise), hypothesis({"a"}, whole, kLeavesNoise),
                                hypothesis({"b"}, 900.0, kLeavesNoise)};
    out[1].log_modal_evidence << modal, modal + 10.0;  // with the least one of them
    out[1].log_prior = -3.0;
    return out;
  };
  EXPECT_EQ(judge(compared(list(60.0, 57.0))), Verdict::missing);
  EXPECT_EQ(believed_effects(compared(list(60.0, 57.0))), std::vector<std::string>{"a"});
  EXPECT_NEAR(compared(list(60.0, 13.5)).given().probability, 1.0 / (1.0 + std::exp(10.5)), 1e-9);
  EXPECT_NEAR(compared(list(13.5, 60.0)).given().probability, 1.0 / (1.0 + std::exp(10.5)), 1e-9);
  EXPECT_EQ(judge(compared(list(60.0, 12.5))), Verdict::adequate) << "too little beside its prior";
  EXPECT_EQ(judge(compared(list(12.5, 60.0))), Verdict::adequate);
  EXPECT_EQ(judge(compared(list(-700.0, 60.0))), Verdict::adequate);
}

// What a pair gains is counted from what its smaller model is believed to gain.
TEST(Comparison, CountsWhatAPairGainsFromItsSmallerModel) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, kLeavesNoise),
                               hypothesis({"a", "b"}, 150.0, kLeavesNoise)};
  EXPECT_EQ(compared(list).best().effects, std::vector<std::string>{"a"});
  list[2].log_modal_evidence << 20.0, 30.0;
  const Comparison pair = compared(list);
  EXPECT_EQ(pair.best().effects, (std::vector<std::string>{"a", "b"}));
  EXPECT_NEAR(pair.best().log_weight, 70.0, 1e-9);
}

// The evidence of what is superfluous still counts for E, but no more than the test that does without it.
TEST(Comparison, TracesWhatMayActWithoutBeingMissed) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, kLeavesNoise), hypothesis({"a"}, 2000.0, kLeavesNoise),
                               hypothesis({"b"}, 1999.0, kLeavesNoise), hypothesis({"c"}, 5000.0, kFails, true)};
  const Comparison strong = compared(list);
  const std::vector<Trace> halves = strong.traces();
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_EQ(halves[0].hypothesis->effects, std::vector<std::string>{"a"});
  EXPECT_NEAR(halves[0].share, 0.5 / (1.0 + std::exp(-1.0)), 1e-9);
  EXPECT_NEAR(halves[0].share + halves[1].share, 0.5, 1e-9);
  list[1].log_evidence = list[2].log_evidence = -2.0;
  const Comparison weak = compared(list);
  EXPECT_NEAR(weak.traces()[0].share, 1.0 / (2.0 + std::exp(2.0)), 1e-9);
  list[0].test.z = kPasses;
  EXPECT_TRUE(compared(list).traces().empty());
}

// The most probable model decides by its own test whether something unknown acts beside it, or beside another model.
TEST(Comparison, GivesToSomethingUnknownWhatTheTestSays) {
  const auto none_of_these = [](double z, double evidence) {
    std::vector<Hypothesis> list{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, z),
                                 hypothesis({"b"}, 20.0, kLeavesNoise), hypothesis({}, 0.0, kFails, true),
                                 hypothesis({"a"}, evidence, kFails, true)};
    for (const std::size_t i : {3, 4}) list[i].log_prior = list[i].log_prior_of_force = -3.0;
    return compared(list).none_of_these();
  };
  for (const double evidence : {20.0, 500.0}) {
    EXPECT_NEAR(none_of_these(-5.0, evidence), 0.5 / (0.5 + std::exp(3.0)), 1e-6);
    EXPECT_LT(none_of_these(2.9, evidence), 0.8);
    EXPECT_NEAR(none_of_these(3.5, evidence), 1.0 / (1.0 + std::exp(3.0 - log_bayes_factor_of_test(3.5))), 1e-6);
    EXPECT_GT(none_of_these(7.0, evidence), 0.999);
  }
}

// A force that explains what a named model leaves along the modes counts, even where the test of all squares passes.
TEST(Comparison, GivesToSomethingUnknownWhatTheModesShow) {
  std::vector<Hypothesis> list{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, kLeavesNoise),
                               hypothesis({"a"}, 60.0, kFails, true)};
  list[2].log_prior = list[2].log_prior_of_force = -3.0;
  list[2].log_modal_evidence << -5.0, 10.0;  // with the larger one of them
  EXPECT_NEAR(compared(list).none_of_these(), 1.0 / (1.0 + std::exp(-7.0)), 1e-9);
  EXPECT_EQ(judge(compared(list)), Verdict::unexplained);
  list[2].log_modal_evidence << -20.0, -30.0;
  EXPECT_EQ(judge(compared(list)), Verdict::missing);
}

TEST(Judge, NeedsBothAProbabilityAndAFit) {
  const auto verdict = [](double given, double given_z, double named, double named_z, double none) {
    return judge(compared({hypothesis({}, std::log(given), given_z), hypothesis({"a"}, std::log(named), named_z),
                           hypothesis({}, std::log(none), kFails, true)}));
  };
  EXPECT_EQ(verdict(0.9, kPasses, 0.1, kLeavesNoise, 0.0), Verdict::adequate);
  EXPECT_EQ(verdict(0.1, kPasses, 0.9, kLeavesNoise, 0.0), Verdict::adequate);  // it is within the believed set
  EXPECT_EQ(verdict(0.01, kFails, 0.99, kLeavesNoise, 0.0), Verdict::missing);
  EXPECT_EQ(verdict(0.0, kFails, 1.0, kFails, 0.0), Verdict::unexplained);
  EXPECT_EQ(verdict(1.0, kFails, 0.0, kLeavesNoise, 0.0), Verdict::unexplained);
  // An effect that barely passes does not explain a recording in which something unknown is as probable beforehand.
  EXPECT_EQ(
      judge(compared({hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, 2.9), hypothesis({"a"}, 60.0, kFails, true)})),
      Verdict::unexplained);
  // Nor does one of several explanations in which something unknown acts, if these are more probable together.
  std::vector<Hypothesis> several{hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, 1.3),
                                  hypothesis({}, 60.0, kFails, true), hypothesis({"b"}, 60.0, kFails, true)};
  several[2].log_prior_of_force = several[3].log_prior_of_force = 0.3 - log_bayes_factor_of_test(1.3);
  EXPECT_EQ(compared(several).best().effects, std::vector<std::string>{"a"});
  EXPECT_NEAR(compared(several).none_of_these(), 1.0 / (1.0 + std::exp(-0.3)), 1e-9);
  EXPECT_EQ(judge(compared(several)), Verdict::unexplained);
  EXPECT_EQ(judge(compared({hypothesis({}, 0.0, kFails), hypothesis({"a"}, 50.0, kLeavesNoise)})), Verdict::missing);
  Comparison mesh = compared({hypothesis({}, 0.0, kLeavesNoise)});
  mesh.passes_without_mesh = false;
  EXPECT_EQ(judge(mesh), Verdict::numerics);
}

}  // namespace
}  // namespace tissue_stiffness
