// The likelihood with the mesh's error, and the evidence.
#include "diagnosis/model_comparison.hpp"

#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <utility>

#include "clean_bar.hpp"
#include "diagnosis/missing_force.hpp"
#include "filter/consistency.hpp"

namespace tissue_stiffness {
namespace {

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

// What a finer mesh changes at one place of the base says nothing of another place.
TEST_F(CleanBar, MarginalisesTheMeshsChangeWhereTheBaseIs) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(base_.rows.error.size()), change = slow();
  ModelComparison models(base_, none);
  const Explained off = rigid(base_.rows.error + change);
  EXPECT_FALSE(models.assess(off).test.passes());
  models.move_base(off.error, change);
  EXPECT_EQ(models.base_cost(), off.error.squaredNorm());
  EXPECT_TRUE(models.assess(off).test.passes());
  EXPECT_NEAR(models.noise_variance(), ModelComparison(base_, none).noise_variance(), 1e-9) << "the least that is known";
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

auto in_frame(const Eigen::VectorXd& rows, FrameRows::Range range) {
  return rows.segment(range.from, range.size);
}

// Returns how many frames of such rows count as one (Bartlett 1946).
double repeated_frames(const Eigen::VectorXd& rows, const FrameRows& frames) {
  double out = 1.0;
  for (Eigen::Index lag = 1; lag < frames.count(); ++lag) {
    double product = 0.0;
    for (Eigen::Index k = lag; k < frames.count(); ++k)
      product += in_frame(rows, frames[k]).dot(in_frame(rows, frames[k - lag]));
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
  const FrameRows& frames = base_.rows.frames;
  for (Eigen::Index k = 0; k < frames.count(); ++k) {
    const auto [from, size] = frames[k];
    reversed.segment(from, size) = in_frame(change, frames[frames.count() - 1 - k]);
  }
  // Here C = s I + b R^2 P, where R^2 is the mean square of a frame, and b such frames count as one. For x along the modes,
  // x^T C^-1 x = |x|^2 / (s + b R^2).
  const double s = models.noise_variance(), share = kComparison.least_of_mesh, repeated = repeated_frames(change, frames);
  EXPECT_GT(repeated, 3.0);
  const double room = repeated * share * share * change.squaredNorm() / static_cast<double>(frames.count());
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
  // Such an error is seen few times, so its mean square may be above its variance. Only the strict test refuses it.
  const Assessment assessment = models.assess(rigid(base_.rows.error + 1.5 * kComparison.whole_mesh * reversed));
  EXPECT_FALSE(assessment.strict_test.passes());
  EXPECT_TRUE(assessment.test.passes());
  EXPECT_TRUE(models.assess(rigid(base_.rows.error + share * reversed)).strict_test.passes());
}

// Each direction is tested against its own error, so a large error along one mode hides nothing along another.
TEST_F(CleanBar, TestsEachModeAgainstTheMeshsErrorThere) {
  const Eigen::MatrixXd parts = ModelComparison(base_, slow()).mesh_directions();
  Eigen::Index other = 1;
  parts.middleCols(1, parts.cols() - 2).colwise().norm().maxCoeff(&other);
  const auto part = [&](Eigen::Index mode) { return Eigen::VectorXd(15.0 * parts.col(mode).normalized()); };
  const ModelComparison models(base_, 10.0 * part(0));
  EXPECT_TRUE(models.assess(rigid(base_.rows.error + part(0))).test.passes());
  EXPECT_FALSE(models.assess(rigid(base_.rows.error + part(other + 1))).test.passes());
}

// What lies across the lowest modes says nothing to the modal evidence, and what lies along them says the same as to the
// whole.
TEST_F(CleanBar, HasTheModalEvidenceOfWhatLiesAlongTheModes) {
  const Eigen::VectorXd& e = base_.rows.error;
  const ModelComparison models(base_, Eigen::VectorXd::Zero(e.size()));
  const Eigen::MatrixXd parts = ModelComparison(base_, slow() + 50.0 * e.cwiseAbs2()).mesh_directions();
  const Assessment before = models.assess(rigid(e));
  const auto loss = [&](const Eigen::VectorXd& x) {
    const Assessment after = models.assess(rigid(e + 10.0 * x.normalized()));
    const Eigen::VectorXd modal = before.log_modal_evidence - after.log_modal_evidence;
    EXPECT_NEAR(modal.maxCoeff(), modal.minCoeff(), 1e-6) << "there is no error of the mesh";
    return std::make_pair(before.log_evidence - after.log_evidence, modal[0]);
  };
  const auto along = loss(parts.col(0)), across = loss(parts.rightCols(1));
  EXPECT_GT(along.first, 10.0);
  EXPECT_NEAR(along.second, along.first, 1e-6);
  EXPECT_GT(across.first, 10.0);
  EXPECT_NEAR(across.second, 0.0, 1e-6);
}

// Along one direction d_k a frame the mesh's error has the variance r^2 L. There the modal evidence is that of
// N(d_k^T e; 0, s + r^2 L), for each r from the smallest to the largest.
TEST_F(CleanBar, HasTheModalEvidenceForEachSizeOfTheMeshsError) {
  const Eigen::VectorXd change = 3.0 * ModelComparison(base_, slow()).mesh_directions().col(0) / kComparison.whole_mesh;
  const ModelComparison models(base_, change);
  const FrameRows& frames = base_.rows.frames;
  Eigen::VectorXd alternating = change;  // a course in time that D does not have
  for (Eigen::Index k = 0; k < frames.count(); k += 2) alternating.segment(frames[k].from, frames[k].size) *= -1.0;
  alternating -= change * (change.dot(alternating) / change.squaredNorm());
  const double s = models.noise_variance(), square = alternating.squaredNorm(),
               variance = s * (square / models.whitened(alternating).squaredNorm() - 1.0);
  const Eigen::VectorXd loss = models.assess(rigid(Eigen::VectorXd::Zero(change.size()))).log_modal_evidence -
                               models.assess(rigid(alternating)).log_modal_evidence;
  const double ratio = kComparison.whole_mesh / kComparison.least_of_mesh;
  EXPECT_GT(variance, s);
  const auto expected = [&](double r) { return 0.5 * square / (s + r * r * variance); };
  EXPECT_NEAR(loss[0], expected(1.0), 0.1 * expected(1.0));
  EXPECT_NEAR(loss[loss.size() - 1], expected(ratio), 0.1 * expected(ratio));
  EXPECT_GT(loss[0], loss[1]);
}

// With errors of the mesh that are r times as large as M allows, the sum of squares b^2 along them counts b^2 v / (v + r^2
// M), and its variance is 2 v^2 w^2 a frame, times the frames that count as one. The test averages the p-value over r.
TEST_F(CleanBar, AveragesTheTestOverTheSizesOfTheMeshsError) {
  const Eigen::VectorXd change = 30.0 * ModelComparison(base_, slow()).mesh_directions().col(0) / kComparison.whole_mesh;
  const ModelComparison models(base_, change);
  const FrameRows& frames = base_.rows.frames;
  Eigen::VectorXd alternating = change;  // a course in time that the change does not have
  for (Eigen::Index k = 0; k < frames.count(); k += 2) alternating.segment(frames[k].from, frames[k].size) *= -1.0;
  const double repeated = repeated_frames(change, frames),
               square = change.squaredNorm() / static_cast<double>(frames.count());
  const auto p_value = [&](const Assessment& assessment) {
    MisfitTest plain = models.test_of(assessment.left, 0.0);
    const double v = plain.noise_level(), dof = plain.structured_dof();
    constexpr int sizes = 1000;
    double out = 0.0;
    for (int i = 0; i < sizes; ++i) {
      const double r =
          kComparison.least_of_mesh * std::pow(kComparison.whole_mesh / kComparison.least_of_mesh, (i + 0.5) / sizes);
      const double share = r * r * square / (v + r * r * square);
      double explained = 0.0;
      for (Eigen::Index k = 0; k < frames.count(); ++k) {
        const Eigen::VectorXd direction = in_frame(change, frames[k]).normalized();
        explained += share * std::pow(direction.dot(in_frame(assessment.left, frames[k])), 2);
      }
      const double variance = 2.0 * v * v * share * share * repeated * static_cast<double>(frames.count());
      const double deviation = std::sqrt(std::pow(plain.deviation() * dof, 2) + variance) / dof;
      out += normal_cdf(-(plain.excess() - explained / dof - plain.shared_noise()) / deviation) / sizes;
    }
    return out;
  };
  for (const double size : {0.5, 1.0, 1.5, 2.5}) {
    const Assessment assessment = models.assess(rigid(base_.rows.error + size * alternating));
    EXPECT_NEAR(std::log(normal_cdf(-assessment.test.z) / p_value(assessment)), 0.0, 0.05) << size;
  }
  const auto z = [&](double size) { return models.assess(rigid(base_.rows.error + size * alternating)).test.z; };
  EXPECT_LT(z(kComparison.least_of_mesh), 1.0);
  EXPECT_GT(z(4.0 * kComparison.whole_mesh), 5.0);
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
  row("`least_of_mesh`", text(kComparison.least_of_mesh));
  row("`unknown_mesh`", text(kComparison.unknown_mesh));
  row("`worthwhile`", text(kComparison.worthwhile));
  row("`smallest`", text(kComparison.smallest));
  row("`promising`", text(kComparison.promising));
  row("`most_unknown`", text(kComparison.most_unknown));
  row("`modes`", text(kComparison.modes));
  row("`most_traces`", text(kComparison.most_traces));
  row("`bound`", text(MisfitTest::bound));
  row("`tolerated`", text(MisfitTest::tolerated));
  row("`most_noise`", text(MisfitTest::most_noise));
  row("`beyond_chance`", text(MisfitTest::beyond_chance));
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

// A slow bending that nothing explains is the work of a force; noise is not.
TEST_F(CleanBar, GivesARandomForceWhatNothingElseExplains) {
  const ModelComparison models(base_, Eigen::VectorXd::Zero(base_.rows.error.size()));
  const RandomForce force(base_);
  EXPECT_LT(log_evidence_gained(force, models.assess(rigid(base_.rows.error)), models).maxCoeff(), 0.0);
  const Assessment bent = models.assess(rigid(base_.rows.error + slow()));
  const double gain = log_evidence_gained(force, bent, models).minCoeff();
  EXPECT_GT(gain, 0.3 * 0.5 * slow().squaredNorm());
  EXPECT_LT(gain, 0.5 * bent.left.squaredNorm() / models.noise_variance());
}

}  // namespace
}  // namespace tissue_stiffness
