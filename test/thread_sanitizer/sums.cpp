// Whether ThreadSanitizer finds a race between the bodies of one of TBB's loops, and takes what the loop orders for
// ordered.
#include <tbb/parallel_for.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <numeric>

namespace {

constexpr int kCount = 4000, kWork = 1000;

void work() {
  for (volatile int k = 0; k < kWork; ++k) continue;
}

long racing_sum() {
  long sum = 0;
  tbb::parallel_for(0, kCount, [&](int i) {
    work();
    sum += i;
  });
  return sum;
}

long ordered_sum() {
  std::array<long, kCount> own{};
  tbb::parallel_for(0, kCount, [&](int i) {
    work();
    own[static_cast<std::size_t>(i)] = i;
  });
  return std::accumulate(own.begin(), own.end(), 0L);
}

}  // namespace

int main(int argc, char** argv) {
  const bool racing = argc > 1 && std::strcmp(argv[1], "racing") == 0;
  std::printf("%ld\n", racing ? racing_sum() : ordered_sum());
}
