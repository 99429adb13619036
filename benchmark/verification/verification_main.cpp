// Prints the figures of verification as a table; exit code 1 when one is out of its bounds.
#include <cstdio>
#include <exception>

#include "figures.hpp"

namespace {

using namespace tissue_stiffness;

int print(const std::vector<Figure>& figures) {
  int broken = 0;
  for (const Figure& figure : figures) {
    std::printf("%-62s %12.5g   %9.5g .. %-9.5g %s\n", figure.name.c_str(), figure.value, figure.lower, figure.upper,
                figure.holds() ? "pass" : "FAIL");
    broken += figure.holds() ? 0 : 1;
  }
  std::fflush(stdout);
  return broken;
}

}  // namespace

int main() {
  std::printf("%-62s %12s   %s\n", "figure", "value", "bounds");
  int broken = 0;
  for (const auto& figures :
       {patch_figures, cantilever_figures, refinement_figures, time_figures, kalman_figures, coverage_figures}) {
    try {
      broken += print(figures());
    } catch (const std::exception& error) {
      std::printf("FAIL: %s\n", error.what());
      ++broken;
    }
  }
  std::printf(broken == 0 ? "all pass\n" : "%d failed\n", broken);
  return broken == 0 ? 0 : 1;
}
