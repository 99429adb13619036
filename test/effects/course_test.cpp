#include "effects/course.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include "../box_model.hpp"

namespace tissue_stiffness {
namespace {

Eigen::VectorXd one(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

TEST(Course, IsLinearBetweenSamplesAndHeldOutside) {
  Course course(LoadInput::Kind::pressure);
  EXPECT_EQ(course.value(3.0, 0), 0.0);
  course.add(1.0, one(10.0));
  EXPECT_EQ(course.value(-5.0, 0), 10.0);
  EXPECT_EQ(course.value(5.0, 0), 10.0);
  course.add(3.0, one(30.0));
  course.add(2.0, one(-10.0));  // late
  EXPECT_DOUBLE_EQ(course.value(1.0, 0), 10.0);
  EXPECT_DOUBLE_EQ(course.value(1.25, 0), 5.0);
  EXPECT_DOUBLE_EQ(course.value(2.0, 0), -10.0);
  EXPECT_DOUBLE_EQ(course.value(2.75, 0), 20.0);
  EXPECT_EQ(course.value(9.0, 0), 30.0);
}

TEST(Course, KeepsTheLaterOfTwoSamplesAtOneTime) {
  Course course(LoadInput::Kind::pressure);
  course.add(1.0, one(10.0));
  course.add(1.0, one(20.0));
  EXPECT_EQ(course.value(1.0, 0), 20.0);
}

TEST(Course, InterpolatesEachComponent) {
  Course course(LoadInput::Kind::wrench);
  Eigen::VectorXd wrench(6);
  wrench << 1, 2, 3, 4, 5, 6;
  course.add(0.0, wrench);
  course.add(1.0, 3.0 * wrench);
  for (int i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(course.value(0.5, i), 2.0 * (i + 1));
}

TEST(Course, ForgetsWhatItWasFed) {
  Course course(LoadInput::Kind::pressure);
  course.add(1.0, one(10.0));
  course.clear();
  EXPECT_TRUE(course.empty());
  EXPECT_EQ(course.value(1.0, 0), 0.0);
}

class CourseSilence : public testing::Test {
 protected:
  static constexpr double kInterval = 0.005;  // [s]
  Course course{LoadInput::Kind::pressure};

  void add(double time) { course.add(time, one(1.0)); }
  void add(int from, int to) {
    for (int k = from; k < to; ++k) add(k * kInterval);
  }
  bool silent(double time) { return course.silence(time).has_value(); }
};

TEST_F(CourseSilence, IsFiveIntervalsLong) {
  add(0, 100);
  EXPECT_FALSE(silent(0.495 + 0.024));
  EXPECT_TRUE(silent(0.495 + 0.026));
  EXPECT_NEAR(course.silence(0.795)->since, 0.3, 1e-12);
  EXPECT_NEAR(course.silence(0.795)->interval, kInterval, 1e-12);
}

TEST_F(CourseSilence, EndsWithTheNextSampleAndIsKnownAfterwards) {
  add(0, 100);
  add(200, 500);  // these came before the frames, as after a stall
  EXPECT_FALSE(silent(0.4));
  EXPECT_TRUE(silent(0.7));
  EXPECT_TRUE(silent(0.999));
  EXPECT_FALSE(silent(1.001));
  EXPECT_FALSE(silent(2.4));
}

// A stamp that is ahead, or a sample that comes late, makes neither a silence nor a longer interval.
TEST_F(CourseSilence, IsNotMadeByBrokenStamps) {
  add(0, 50);
  add(0.9);
  EXPECT_FALSE(silent(0.25));
  add(51, 100);
  add(50 * kInterval);
  EXPECT_FALSE(silent(0.255));
  EXPECT_FALSE(silent(0.49));
  EXPECT_TRUE(silent(0.6));
}

TEST_F(CourseSilence, IsNotKnownOfALoadThatHasHardlyBegun) {
  EXPECT_FALSE(silent(1.0));
  add(0, 3);
  EXPECT_FALSE(silent(1.0));
  add(3, 5);
  EXPECT_TRUE(silent(1.0));
  EXPECT_FALSE(silent(-1.0));
  course.clear();
  EXPECT_FALSE(silent(1.0));
}

TEST_F(CourseSilence, ASlowLoadMayPauseForLonger) {
  for (int k = 0; k < 10; ++k) add(double(k));
  EXPECT_FALSE(silent(13.9));
  EXPECT_TRUE(silent(14.1));
}

class CsvCourse : public testing::Test {
 protected:
  ~CsvCourse() override { std::remove(file_.c_str()); }
  Course read(const std::string& content, LoadInput::Kind kind = LoadInput::Kind::pressure) {
    std::ofstream(file_) << content;
    return Course::from_csv(file_, kind);
  }
  std::string refused(const std::string& content, LoadInput::Kind kind = LoadInput::Kind::pressure) {
    return refusal([&] { read(content, kind); });
  }
  const std::string file_ = testing::TempDir() + "course_test.csv";
};

TEST_F(CsvCourse, ReadsRowsAndCountsFromTheFirstStamp) {
  Course course = read("time,pressure\n# at rest\n0, 0\n\n0.5,100\r\n1.0,300\n");
  EXPECT_DOUBLE_EQ(course.value(0.75, 0), 200.0);
  course.start(1000.0, 1000.0);
  EXPECT_DOUBLE_EQ(course.value(1000.75, 0), 200.0);
  course.clear();  // of measured samples, not of the file's
  EXPECT_DOUBLE_EQ(course.value(1000.75, 0), 200.0);
}

TEST_F(CsvCourse, NamesTheLineThatDoesNotFit) {
  EXPECT_NE(refused("0,1\n0.5,soft\n").find("course_test.csv:2"), std::string::npos);
  EXPECT_NE(refused("0,1\nsoft,2\n").find("course_test.csv:2"), std::string::npos);
  EXPECT_NE(refused("0,1,2,3,4,5,6\n0.5,1,2\n", LoadInput::Kind::wrench).find("course_test.csv:2"), std::string::npos);
  EXPECT_NE(refused("time,pressure\n").find("no rows"), std::string::npos);
  EXPECT_NE(refusal([] { Course::from_csv("/nowhere/p.csv", LoadInput::Kind::pressure); }).find("/nowhere/p.csv"),
            std::string::npos);
}

// A tool that starts anywhere, turned, and turns on by 0.3 rad about its own axis while it moves.
TEST(Course, GivesTheMotionOfAPoseSinceRest) {
  const Eigen::Matrix3d before = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix(),
                        turn = Eigen::AngleAxisd(0.3, Eigen::Vector3d(0, 1, 2).normalized()).toRotationMatrix();
  const Eigen::Vector3d at(0.5, -0.2, 0.3), moved(0.51, -0.2, 0.29);
  Course course(LoadInput::Kind::pose);
  course.set_smoothing(0.0);
  course.start(10.0, 11.0);
  course.add(10.0, pose_values(Eigen::Translation3d(9, 9, 9) * Eigen::Quaterniond::Identity()));  // before rest
  course.add(11.0, pose_values(Eigen::Translation3d(at) * Eigen::Quaterniond(before)));
  course.add(12.0, pose_values(Eigen::Translation3d(moved) * Eigen::Quaterniond(turn * before)));
  const auto place = [&](double time, const Eigen::Vector3d& x) {
    Eigen::Vector3d out = x;
    for (int i = 0; i < 3; ++i) {
      out[i] += course.value(time, i);
      for (int j = 0; j < 3; ++j) out[i] += course.value(time, 3 + 3 * j + i) * x[j];
    }
    return out;
  };
  const Eigen::Vector3d x(0.48, -0.25, 0.31);
  EXPECT_LT((place(11.0, x) - x).norm(), 1e-15);
  EXPECT_LT((place(12.0, x) - (moved + turn * (x - at))).norm(), 1e-15);
  EXPECT_LT((place(11.5, at) - 0.5 * (at + moved)).norm(), 1e-15);
}

// The pose itself, which a tool's shape needs, and not its motion since rest. An estimated error of its place is taken off.
TEST(Course, GivesThePoseItself) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  const Eigen::Vector3d at(0.5, -0.2, 0.3);
  Course course(LoadInput::Kind::pose);
  course.set_smoothing(0.0);
  course.start(0.0, 0.0);
  EXPECT_FALSE(course.pose(0.0));
  for (int k = 0; k <= 4; ++k) {
    const Eigen::Vector3d shift(0.01 * k, 0.0, 0.0);
    course.add(0.1 * k, pose_values(Eigen::Translation3d(at + shift) * Eigen::Quaterniond(turn)));
  }
  const auto pose = course.pose(0.25);
  ASSERT_TRUE(pose);
  EXPECT_LT((pose->leftCols<3>() - turn).norm(), 1e-12);
  EXPECT_LT((pose->col(3) - at - Eigen::Vector3d(0.025, 0.0, 0.0)).norm(), 1e-12);
  LoadTolerance tolerance{0.0, 1e-3, 0.0, 0.5, 0.0, 0.0, 0.0};
  const auto measured = [&](double t) { return Eigen::VectorXd(Eigen::Vector3d(course.measured(t, 0), 0.0, 0.0)); };
  course.correct(LoadErrorBasis(tolerance, measured, 3, 0.0, 0.4), Eigen::Vector3d(2.0, 0.0, -1.0));
  EXPECT_LT((course.pose(0.25)->col(3) - pose->col(3) - Eigen::Vector3d(-2e-3, 0.0, 1e-3)).norm(), 1e-12);
}

// An arm at 200 Hz whose encoders are noisy: the path is near its true one, and its accelerations are.
TEST(Course, SmoothesThePosesOfAnArm) {
  const auto truth = [](double t) { return 0.003 * (1.0 - std::cos(2.0 * M_PI * t)); };
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 2e-5);
  Course smooth(LoadInput::Kind::pose), rough(LoadInput::Kind::pose);
  rough.set_smoothing(0.0);
  for (int k = 0; k <= 400; ++k) {
    const double t = 0.005 * k;
    const Eigen::VectorXd pose =
        pose_values(Eigen::Translation3d(truth(t) + noise(random), 0, 0) * Eigen::AngleAxisd::Identity());
    smooth.add(t, pose);
    rough.add(t, pose);
  }
  const auto errors = [&](const Course& course) {
    const double h = 0.004;
    double place = 0.0, acceleration = 0.0;
    for (double t = 0.1; t < 1.9; t += h) {
      const double off = course.value(0.1, 0) - truth(0.1);
      place = std::max(place, std::abs(course.value(t, 0) - truth(t) - off));
      const double second = course.value(t + h, 0) - 2.0 * course.value(t, 0) + course.value(t - h, 0);
      acceleration =
          std::max(acceleration, std::abs(second / (h * h) - 0.003 * 4.0 * M_PI * M_PI * std::cos(2.0 * M_PI * t)));
    }
    return Eigen::Vector2d(place, acceleration);
  };
  const Eigen::Vector2d of_smooth = errors(smooth), of_rough = errors(rough);
  std::printf("smooth: %.1e m, %.2f m/s^2; rough: %.1e m, %.2f m/s^2\n", of_smooth[0], of_smooth[1], of_rough[0],
              of_rough[1]);
  EXPECT_LT(of_smooth[0], 0.75 * of_rough[0]);
  EXPECT_LT(of_smooth[1], 0.35 * of_rough[1]);
}

TEST(Course, OrderDoesNotMatterToAPath) {
  Course one(LoadInput::Kind::pose), other(LoadInput::Kind::pose);
  const auto pose = [](int k) {
    return pose_values(Eigen::Translation3d(0.001 * k * k, 0, 0) * Eigen::AngleAxisd(0.01 * k, Eigen::Vector3d::UnitZ()));
  };
  for (int k = 0; k < 20; ++k) one.add(0.01 * k, pose(k));
  for (int k = 19; k >= 0; --k) other.add(0.01 * k, pose(k));
  for (int i = 0; i < 12; ++i) {
    for (double t = -0.05; t < 0.25; t += 0.003) EXPECT_DOUBLE_EQ(one.value(t, i), other.value(t, i)) << t;
  }
}

TEST_F(CsvCourse, ReadsPosesAndRefusesAQuaternionThatIsNone) {
  const Course course = read("time,x,y,z,qx,qy,qz,qw\n0,0,0,0.1,0,0,0,1\n1,0,0,0.09,0,0,0,1\n", LoadInput::Kind::pose);
  EXPECT_NEAR(course.value(1.0, 2), -0.01, 1e-15);
  EXPECT_NEAR(course.value(1.0, 4), 0.0, 1e-15);
  EXPECT_NE(refused("0,0,0,0.1,0,0,0,2\n", LoadInput::Kind::pose).find("course_test.csv:1"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
