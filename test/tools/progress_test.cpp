// What a terminal and a log see of long work.
#include "tissue_stiffness/tools/progress.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <thread>

namespace tissue_stiffness {
namespace {

using Style = Progress::Style;

TEST(StepProgress, TellsTheTimeLeftWhereStepsAreCounted) {
  std::ostringstream out;
  StepProgress progress(out, Style::lines, "work");
  progress.show("begin");
  EXPECT_EQ(out.str(), "work [step 1, 0.0 s] begin\n") << "nobody counts";
  out.str("");
  progress.show("first", 0, 4);
  EXPECT_NE(out.str().find("; 0 of 4 done] first\n"), std::string::npos) << out.str();
  out.str("");
  std::this_thread::sleep_for(std::chrono::milliseconds(700));
  progress.show("third", 2, 4);  // two took 0.7 s: so will the other two
  EXPECT_NE(out.str().find("; 2 of 4 done, 1 s left] third\n"), std::string::npos) << out.str();
}

TEST(StepProgress, CountsEachPhaseFromItsOwnBeginning) {
  std::ostringstream out;
  StepProgress progress(out, Style::lines, "work");
  std::this_thread::sleep_for(std::chrono::milliseconds(900));
  progress.show("first", 0, 2);
  out.str("");
  progress.show("second", 1, 2);
  EXPECT_NE(out.str().find("; 1 of 2 done, 0 s left] second"), std::string::npos) << out.str();
}

TEST(StepProgress, DoesNotGuessTheTimeLeftFromTheFirstFew) {
  std::ostringstream out;
  StepProgress progress(out, Style::lines, "work");
  progress.show("one", 0, 100);
  progress.show("two", 2, 100);
  EXPECT_EQ(out.str().find("left"), std::string::npos);
  progress.show("twelve", 12, 100);
  EXPECT_NE(out.str().find("left"), std::string::npos);
}

TEST(StepProgress, SaysLittleWhileOneStepGoesOn) {
  std::ostringstream out;
  StepProgress progress(out, Style::lines, "work");
  for (std::size_t done = 0; done <= 50; ++done) progress.show("tangents", done, 50);
  EXPECT_EQ(out.str(), "work [step 1, 0.0 s; 0 of 50 done] tangents\n");
  progress.show("next", 1, 50);
  EXPECT_NE(out.str().find("work [step 2, "), std::string::npos);
}

TEST(StepProgress, KeepsToOneLineOnATerminal) {
  std::ostringstream out;
  StepProgress progress(out, Style::bar, "work");
  progress.show("first", 0, 2);
  progress.show("second", 1, 2);
  EXPECT_EQ(out.str().find('\n'), std::string::npos);
  EXPECT_EQ(out.str().front(), '\r');
  progress.finish();
  EXPECT_EQ(out.str().back(), '\n');
}

TEST(StepProgress, IsSilentWhenItIsTold) {
  std::ostringstream out;
  StepProgress progress(out, Style::quiet, "work");
  progress.show("first", 0, 2);
  progress.finish();
  EXPECT_TRUE(out.str().empty());
}

}  // namespace
}  // namespace tissue_stiffness
