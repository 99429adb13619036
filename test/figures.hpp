#pragma once

#include <gtest/gtest.h>

#include <cstdio>

#include "verification/figures.hpp"

namespace tissue_stiffness {

inline void expect_all(const std::vector<Figure>& figures) {
  ASSERT_FALSE(figures.empty());
  for (const Figure& figure : figures) {
    std::printf("%s: %.4g\n", figure.name.c_str(), figure.value);
    EXPECT_TRUE(figure.holds()) << figure.name << " is " << figure.value << ", not within " << figure.lower << " to "
                                << figure.upper;
  }
}

}  // namespace tissue_stiffness
