#include "types/freed_memory.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstring>
#include <fstream>
#include <memory>
#include <thread>
#include <vector>

namespace tissue_stiffness {
namespace {

constexpr int kThreads = 4, kBlocks = 10, kHeld = 1000;
constexpr std::size_t kLarge = 2 * 1024 * 1024;  // [byte]

using Block = std::unique_ptr<char[]>;

Block filled(std::size_t size) {
  Block out(new char[size]);
  std::memset(out.get(), 1, size);
  return out;
}

double resident_megabytes() {
  std::ifstream file("/proc/self/statm");
  long all = 0, resident = 0;
  file >> all >> resident;
  return static_cast<double>(resident * sysconf(_SC_PAGESIZE)) / 1e6;
}

/// A job as in the background of a node: many large blocks come and go, and a small one that came last is kept.
void work(std::vector<Block>& kept) {
  filled(kLarge);  // from then on glibc takes blocks of this size from the heap, unless told otherwise
  std::vector<Block> blocks;
  for (int k = 0; k < kBlocks; ++k) blocks.push_back(filled(kLarge));
  kept.push_back(filled(kHeld));
}

/// How much memory a process holds after the jobs beyond what it held before [MB].
double left_after_jobs() {
  std::vector<Block> kept;
  const double before = resident_megabytes();
  for (int k = 0; k < kThreads; ++k) std::thread(work, std::ref(kept)).join();
  return resident_megabytes() - before;
}

TEST(FreedMemory, OfBackgroundJobsGoesBackToTheSystem) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a sanitizer has a malloc of its own";
#endif
  const pid_t child = fork();  // the settings hold for a whole process
  ASSERT_GE(child, 0);
  if (child == 0) {
    return_large_blocks();
    _exit(left_after_jobs() < 0.5 * kBlocks * kLarge / 1e6 ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

}  // namespace
}  // namespace tissue_stiffness
