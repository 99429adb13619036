#include "estimation/change_watch.hpp"

#include <gtest/gtest.h>

namespace tissue_stiffness {
namespace {

class ChangeWatchTest : public testing::Test {
 protected:
  ChangeWatch watch{true};
  PosteriorLinearizationFilter filter{Eigen::VectorXd::Ones(1), Eigen::MatrixXd::Identity(1, 1)};

  void add(double square, int frames) {
    for (int k = 0; k < frames; ++k) watch.add(square, filter);
  }
};

TEST_F(ChangeWatchTest, ARiseOfTheMisfitIsSuspicious) {
  add(1.0, 20);
  EXPECT_FALSE(watch.suspicious());
  add(4.0, 6);
  EXPECT_TRUE(watch.suspicious());
  const auto question = watch.due();
  ASSERT_TRUE(question);
  EXPECT_EQ(question->misfit, 1.0);
  EXPECT_EQ(question->w[0], 1.0);
}

// A model that never fits better, or a noise stated too small, is no change.
TEST_F(ChangeWatchTest, AMisfitThatIsUsualIsNotSuspicious) {
  add(3.0, 60);
  EXPECT_FALSE(watch.suspicious());
  EXPECT_FALSE(watch.due());
  add(8.0, 6);
  EXPECT_TRUE(watch.suspicious());
  const auto question = watch.due();
  ASSERT_TRUE(question);
  EXPECT_NEAR(question->misfit, 3.0, 1e-9);
}

TEST_F(ChangeWatchTest, TheUsualMisfitOutlivesAChangeButNoRestart) {
  add(3.0, 60);
  watch.go_on();
  add(3.0, 12);
  EXPECT_FALSE(watch.suspicious());
  watch.restart();
  add(1.0, 12);
  add(3.0, 6);
  EXPECT_TRUE(watch.suspicious());
}

TEST_F(ChangeWatchTest, WithoutADriftNothingIsSuspected) {
  watch = ChangeWatch(false);
  add(1.0, 20);
  add(100.0, 20);
  EXPECT_FALSE(watch.suspicious());
}

}  // namespace
}  // namespace tissue_stiffness
