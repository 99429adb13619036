// What is said of the most probable hypothesis, where it is one effect or a pair.
#include "diagnosis/describe.hpp"

#include "clean_bar.hpp"
#include "diagnosis/residual_views.hpp"

namespace tissue_stiffness {
namespace {

using Names = std::vector<std::string>;

class Described : public CleanBar {
 protected:
  void SetUp() override {
    CleanBar::SetUp();
    base_.rows.error += slow();
  }

  // Leaves `left` of what the given model misses.
  Hypothesis hypothesis(Names effects, double weight, double left) const {
    Hypothesis out;
    out.effects = std::move(effects);
    out.log_evidence = weight;
    out.log_modal_evidence = Eigen::VectorXd::Zero(1);
    out.test.z = 1e3 * left;
    out.explained = std::make_shared<const Explained>(rigid(base_.rows.error - (1.0 - left) * slow()));
    return out;
  }
};

TEST_F(Described, APairIsTheBestExplanationAsAWhole) {
  Comparison c;
  c.hypotheses = {hypothesis({}, -1e4, 1.0), hypothesis({"mass_damping"}, -1e3, 0.5),
                  hypothesis({"active_contraction", "mass_damping"}, -10.0, 0.0)};
  c.find_probabilities();
  const BestExplanation best = best_explanation(base_, c);
  EXPECT_EQ(best.effects, (Names{"active_contraction", "mass_damping"}));
  const double noise = (base_.rows.error - slow()).squaredNorm();
  EXPECT_NEAR(best.explained, 1.0 - noise / base_.rows.error.squaredNorm(), 1e-12);
  RecordingRows left = base_.rows;
  left.error -= slow();
  EXPECT_DOUBLE_EQ(best.held_out_rms, rms_error(left, base_.recording_fit->recording(), true));
  EXPECT_TRUE(others_in_set(believed_effects(c), best).empty()) << "two effects that act together";
}

TEST_F(Described, NothingIsNearestWhereNothingWasFitted) {
  Comparison c;
  c.hypotheses = {hypothesis({}, 0.0, 1.0)};
  c.find_probabilities();
  EXPECT_TRUE(best_explanation(base_, c).effects.empty());
}

TEST(NextExperiment, TellsTheBestExplanationFromTheOthers) {
  const BestExplanation one{{"gravity"}, 0.9, 1e-4}, two{{"gravity", "added_mass"}, 0.9, 1e-4};
  EXPECT_EQ(others_in_set({"gravity", "rigid_drift"}, one), Names{"rigid_drift"});
  EXPECT_EQ(others_in_set({"gravity", "added_mass", "rigid_drift"}, two), Names{"rigid_drift"});
  EXPECT_EQ(next_experiment({"gravity", "added_mass", "rigid_drift"}, two),
            next_experiment({"gravity", "rigid_drift"}, one));
  EXPECT_EQ(next_experiment({"gravity", "rigid_drift"}, one), "turn the body, or keep the sensor still on a fixed target");
  EXPECT_TRUE(others_in_set({"gravity", "added_mass"}, two).empty());
  EXPECT_EQ(next_experiment({"gravity", "added_mass"}, two), "");
}

}  // namespace
}  // namespace tissue_stiffness
