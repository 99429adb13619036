// What a terminal and a log see of long work.
#include "tools/progress.hpp"

#include <gtest/gtest.h>

#include <sstream>

namespace tissue_stiffness {
namespace {

using Style = Progress::Style;

class StepProgressTest : public testing::Test {
 protected:
  std::ostringstream out;
  double now = 100.0;  // [s]

  StepProgress lines() {
    return StepProgress(out, Style::lines, "work", [this] { return now; });
  }
};

TEST_F(StepProgressTest, TellsTheTimeLeftWhereStepsAreCounted) {
  StepProgress progress = lines();
  progress.show("begin");
  EXPECT_EQ(out.str(), "work [step 1, 0.0 s] begin\n") << "nobody counts";
  out.str("");
  progress.show("first", 0, 4);
  EXPECT_NE(out.str().find("; 0 of 4 done] first\n"), std::string::npos) << out.str();
  out.str("");
  now += 0.7;
  progress.show("third", 2, 4);  // two took 0.7 s: so will the other two
  EXPECT_NE(out.str().find("; 2 of 4 done, 1 s left] third\n"), std::string::npos) << out.str();
}

TEST_F(StepProgressTest, CountsEachPhaseFromItsOwnBeginning) {
  StepProgress progress = lines();
  now += 0.9;
  progress.show("first", 0, 2);
  out.str("");
  progress.show("second", 1, 2);
  EXPECT_NE(out.str().find("; 1 of 2 done, 0 s left] second"), std::string::npos) << out.str();
}

TEST_F(StepProgressTest, DoesNotGuessTheTimeLeftFromTheFirstFew) {
  StepProgress progress = lines();
  progress.show("one", 0, 100);
  progress.show("two", 2, 100);
  EXPECT_EQ(out.str().find("left"), std::string::npos);
  progress.show("twelve", 12, 100);
  EXPECT_NE(out.str().find("left"), std::string::npos);
}

TEST_F(StepProgressTest, SaysLittleWhileOneStepGoesOn) {
  StepProgress progress = lines();
  for (std::size_t done = 0; done <= 50; ++done) progress.show("tangents", done, 50);
  EXPECT_EQ(out.str(), "work [step 1, 0.0 s; 0 of 50 done] tangents\n");
  progress.show("next", 1, 50);
  EXPECT_NE(out.str().find("work [step 2, "), std::string::npos);
}

TEST_F(StepProgressTest, KeepsToOneLineOnATerminal) {
  StepProgress progress(out, Style::bar, "work");
  progress.show("first", 0, 2);
  progress.show("second", 1, 2);
  EXPECT_EQ(out.str().find('\n'), std::string::npos);
  EXPECT_EQ(out.str().front(), '\r');
  progress.finish();
  EXPECT_EQ(out.str().back(), '\n');
}

TEST_F(StepProgressTest, IsSilentWhenItIsTold) {
  StepProgress progress(out, Style::quiet, "work");
  progress.show("first", 0, 2);
  progress.finish();
  EXPECT_TRUE(out.str().empty());
}

}  // namespace
}  // namespace tissue_stiffness
