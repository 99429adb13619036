// Work in a child process: its result comes back, its crash does not, and it can be ended.
#include "meshing/run_apart.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>

#include "tissue_stiffness/types/error.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

TEST(RunApart, BringsBackBytesAndSurvivesACrash) {
  const std::string bytes(200000, 'x');  // more than a pipe holds
  EXPECT_EQ(run_apart([&] { return bytes; }, 10), bytes);
  EXPECT_EQ(run_apart([]() -> std::string { std::abort(); }, 10), std::nullopt);
}

TEST(RunApart, EndsTheChildWhenItIsInterrupted) {
  StopRequest stop;
  stop.stop();
  const auto forever = []() -> std::string {
    while (true) pause();
  };
  EXPECT_THROW(run_apart(forever, 60, [&] { stop.check(); }), Interrupted);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD) << "no child is left";
}

}  // namespace
}  // namespace tissue_stiffness
