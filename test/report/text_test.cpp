// Numbers and names as people read them.
#include "report/text.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "report/course.hpp"

namespace tissue_stiffness {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(Text, NumbersForPeople) {
  EXPECT_EQ(rounded(412.34, 0.61), "412.34");
  EXPECT_EQ(rounded(412.34, 6.1), "412.3");
  EXPECT_EQ(rounded(41234.0, 610.0), "41230");
  EXPECT_EQ(rounded(3.0, nan), "3.000");
  EXPECT_EQ(short_number(nan, 3), "-");
  EXPECT_EQ(short_number(0.00012345, 3), "0.000123");
  EXPECT_EQ(short_number(1.5e9, 2), "1.5e+09");
  EXPECT_EQ(fixed_number(nan, 1), "-");
  EXPECT_EQ(fixed_number(-0.04, 1), "0.0");
  EXPECT_EQ(fixed_number(-0.06, 1), "-0.1");
  EXPECT_EQ(fixed_number(1334.56, 1), "1334.6");
  EXPECT_EQ(exact_number(0.1), "0.1");
  EXPECT_EQ(exact_number(nan), "");
  EXPECT_EQ(shown_unit(30e3, "Pa").name, "kPa");
  EXPECT_EQ(shown_unit(3e-4, "m").name, "mm");
  EXPECT_EQ(shown_unit(3e-5, "m").name, "µm");
  EXPECT_EQ(shown_unit(5000.0, "m").name, "m");
  EXPECT_EQ(shown_unit(0.02, "1/s").name, "1/s");
  EXPECT_EQ(shown_unit(0.45, "-").name, "");
  EXPECT_EQ(parameter_title("elasticity#2.young_modulus"), "Young's modulus (elasticity#2)");
}

}  // namespace
}  // namespace tissue_stiffness
