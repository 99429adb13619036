// Numbers and names as people read them.
#include "report/text.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "report/course.hpp"
#include "types/plain_number.hpp"

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
  EXPECT_EQ(short_number(1e3 * 1e-4, 3), "0.100");
  EXPECT_EQ(short_number(0.09996, 3), "0.100");
  EXPECT_EQ(short_number(999.7, 3), "1000");
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
  EXPECT_EQ(with_unit(-9.62e-5, "-"), "-0.00962 %");
  EXPECT_EQ(with_unit(0.0, "-"), "0");
  EXPECT_EQ(shown_unit(1e-12, "m").name, "nm");
  EXPECT_EQ(with_unit(1.5147765e-8, "m^3/N"), "15.1 mm^3/N");
  EXPECT_EQ(with_unit(17018.0, "N/m^3"), "17.0 kN/m^3");
  EXPECT_EQ(with_unit(-3.27e-6, "m/s"), "-3.27 µm/s");
  EXPECT_EQ(with_unit(2.4e-5, "s^2"), "24.0 ms^2");
  EXPECT_EQ(with_unit(0.0602, "rad"), "60.2 mrad");
  EXPECT_EQ(with_unit(0.00224, "kg"), "2.24 g");
  EXPECT_EQ(with_unit(-2e-5, "kg"), "-20.0 mg");
  EXPECT_EQ(with_unit(1060.0, "kg/m^3"), "1060 kg/m^3");
  EXPECT_EQ(with_unit(344.1, "1/s"), "344 1/s");
  EXPECT_EQ(with_unit(1.5, "-"), "1.50");
  EXPECT_EQ(with_unit(0.0, "Pa"), "0 Pa");
  EXPECT_EQ(with_unit(nan, "Pa"), "-");
  EXPECT_EQ(parameter_title("elasticity#2.young_modulus"), "Young's modulus (elasticity#2)");
}

TEST(Text, SharesAndTestsForPeople) {
  EXPECT_EQ(percentage(0.8836, 3), "88.4 %");
  EXPECT_EQ(percentage(0.0, 2), "< 0.1 %");
  EXPECT_EQ(percentage(1e-3, 2), "0.10 %");
  EXPECT_EQ(percentage(0.9995, 2), "> 99.9 %");
  EXPECT_EQ(percentage(1.0, 2), "100 %");
  EXPECT_EQ(percentage(nan, 2), "-");
  EXPECT_EQ(test_statistic(1.24), "1.2");
  EXPECT_EQ(test_statistic(1323.2), "> 100");
  EXPECT_EQ(test_statistic(nan), "-");
}

TEST(Text, PositionsInMillimetres) {
  EXPECT_EQ(position_in_millimetres({-0.003, 0.013, 0.0414}), "(-3, 13, 41)");
  EXPECT_EQ(position_in_millimetres({0.0, 1.0, -0.0004}), "(0, 1000, 0)");
  EXPECT_EQ(position_in_millimetres({nan, -0.0026, 0.0}), "(-, -3, 0)");
}

TEST(Text, EstimatesOfAllPagesAreRoundedAlike) {
  const ShownEstimate e = shown_estimate({"elasticity.young_modulus", "Pa", 12326.2, 772.0, 10844.2, 13952.9}, 1e-3);
  EXPECT_EQ(e.mean, "12.3");
  EXPECT_EQ(e.lower, "10.8");
  EXPECT_EQ(e.upper, "14.0");
  EXPECT_EQ(shown_estimate({"a.b", "-", 1.5, nan, nan, 2.0}, 1.0).mean, "1.500");
  EXPECT_EQ(shown_moduli({{"elasticity.young_modulus", 11863.1}, {"viscoelasticity.tau", 0.2}}), "11.86 kPa");
  EXPECT_EQ(shown_moduli({{"viscoelasticity.tau", 0.2}}), "");
}

}  // namespace
}  // namespace tissue_stiffness
