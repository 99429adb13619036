#include "effects/course.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>

#include "../box_model.hpp"

namespace tissue_stiffness {
namespace {

Eigen::VectorXd one(double value) {
  return Eigen::VectorXd::Constant(1, value);
}

TEST(Course, IsLinearBetweenSamplesAndHeldOutside) {
  Course course(1);
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
  Course course(1);
  course.add(1.0, one(10.0));
  course.add(1.0, one(20.0));
  EXPECT_EQ(course.value(1.0, 0), 20.0);
}

TEST(Course, InterpolatesEachComponent) {
  Course course(6);
  Eigen::VectorXd wrench(6);
  wrench << 1, 2, 3, 4, 5, 6;
  course.add(0.0, wrench);
  course.add(1.0, 3.0 * wrench);
  for (int i = 0; i < 6; ++i) EXPECT_DOUBLE_EQ(course.value(0.5, i), 2.0 * (i + 1));
}

TEST(Course, ForgetsWhatItWasFed) {
  Course course(1);
  course.add(1.0, one(10.0));
  course.clear();
  EXPECT_TRUE(course.empty());
  EXPECT_EQ(course.value(1.0, 0), 0.0);
}

class CsvCourse : public testing::Test {
 protected:
  ~CsvCourse() override { std::remove(file_.c_str()); }
  Course read(const std::string& content, int components = 1) {
    std::ofstream(file_) << content;
    return Course::from_csv(file_, components);
  }
  std::string refused(const std::string& content, int components = 1) {
    return refusal([&] { read(content, components); });
  }
  const std::string file_ = testing::TempDir() + "course_test.csv";
};

TEST_F(CsvCourse, ReadsRowsAndCountsFromTheFirstStamp) {
  Course course = read("time,pressure\n# at rest\n0, 0\n\n0.5,100\r\n1.0,300\n");
  EXPECT_DOUBLE_EQ(course.value(0.75, 0), 200.0);
  course.shift(1000.0);
  EXPECT_DOUBLE_EQ(course.value(1000.75, 0), 200.0);
  course.clear();  // of measured samples, not of the file's
  EXPECT_DOUBLE_EQ(course.value(1000.75, 0), 200.0);
}

TEST_F(CsvCourse, NamesTheLineThatDoesNotFit) {
  EXPECT_NE(refused("0,1\n0.5,soft\n").find("course_test.csv:2"), std::string::npos);
  EXPECT_NE(refused("0,1\nsoft,2\n").find("course_test.csv:2"), std::string::npos);
  EXPECT_NE(refused("0,1,2,3,4,5,6\n0.5,1,2\n", 6).find("course_test.csv:2"), std::string::npos);
  EXPECT_NE(refused("time,pressure\n").find("no rows"), std::string::npos);
  EXPECT_NE(refusal([] { Course::from_csv("/nowhere/p.csv", 1); }).find("/nowhere/p.csv"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
