// Acts side by side: an error of one leaves the work of the others whole.
#include "forward/for_each_index.hpp"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace tissue_stiffness {
namespace {

constexpr int kInner = 2000;

/// How much of an inner loop is done where a sibling fails early in it; `gone` is set when that sibling fails.
int work_through(const std::atomic<bool>& gone) {
  std::vector<char> done(kInner, 0);
  tbb::parallel_for(0, kInner, [&](int k) {
    while (!gone) std::this_thread::yield();
    std::this_thread::sleep_for(std::chrono::microseconds(20));  // the error is on its way
    done[static_cast<std::size_t>(k)] = 1;
  });
  return static_cast<int>(std::count(done.begin(), done.end(), 1));
}

TEST(ForEachIndex, AnErrorLeavesTheInnerLoopsOfItsSiblingsAlone) {
  for (int repeat = 0; repeat < 3; ++repeat) {
    std::atomic<bool> gone{false};
    int done = 0;
    const auto fail = [&] {
      gone = true;
      throw std::runtime_error("failed");
    };
    EXPECT_THROW(run_side_by_side(fail, [&] { done = work_through(gone); }), std::runtime_error);
    EXPECT_EQ(done, kInner);
  }
}

TEST(ForEachIndex, TheLowestErrorIsThrownWhenAllHaveEnded) {
  std::atomic<int> ended{0};
  const auto act = [&](std::size_t i) {
    ++ended;
    if (i % 3 == 2) throw std::runtime_error(std::to_string(i));
  };
  try {
    for_each_index(100, act);
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_STREQ(error.what(), "2");
  }
  EXPECT_EQ(ended, 100);
}

}  // namespace
}  // namespace tissue_stiffness
