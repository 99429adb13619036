// Numbers in sentences.
#include "types/two_digits.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace tissue_stiffness {
namespace {

TEST(TwoDigits, HaveNoExponentWhereNobodyExpectsOne) {
  EXPECT_EQ(two_digits(217.0), "217");
  EXPECT_EQ(two_digits(99.6), "100");
  EXPECT_EQ(two_digits(9.96), "10");
  EXPECT_EQ(two_digits(9.44), "9.4");
  EXPECT_EQ(two_digits(0.0314), "0.031");
  EXPECT_EQ(two_digits(-1.25e5), "-125000");
  EXPECT_EQ(two_digits(1.24e-6), "1.2e-06");
}

TEST(TwoDigits, ShowWhatIsNoNumber) {
  EXPECT_EQ(two_digits(0.0), "0");
  EXPECT_EQ(two_digits(std::numeric_limits<double>::quiet_NaN()), "nan");
  EXPECT_EQ(two_digits(std::numeric_limits<double>::infinity()), "inf");
}

}  // namespace
}  // namespace tissue_stiffness
