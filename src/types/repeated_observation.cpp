#include "types/repeated_observation.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

template <typename Matrix>
bool equal(const Matrix& a, const Matrix& b) {
  if (a.cols() != b.cols() || a.rows() != b.rows()) return false;
  return (a.array() == b.array() || (a.array() != a.array() && b.array() != b.array())).all();  // no number equals another
}

bool same(const Observation& a, const Observation& b) {
  if (a.source != b.source || a.time != b.time || !a.contour != !b.contour || !a.tracks != !b.tracks) return false;
  return equal(a.points, b.points) && equal(a.ids, b.ids) && (!a.contour || equal(a.contour->points, b.contour->points)) &&
         (!a.tracks || equal(a.tracks->pixels, b.tracks->pixels));
}

using Iterator = std::vector<Observation>::const_iterator;

bool repeats_one_of(Iterator begin, Iterator end) {
  return std::any_of(begin, end, [&](const Observation& earlier) { return same(earlier, *end); });
}

}  // namespace

bool holds_repeats(const Frame& frame) {
  const auto& all = frame.observations;
  for (auto one = all.begin(); one != all.end(); ++one) {
    if (repeats_one_of(all.begin(), one)) return true;
  }
  return false;
}

int leave_out_repeats(Frame& frame) {
  auto& all = frame.observations;
  int out = 0;
  for (auto one = all.begin(); one != all.end();) {
    const bool repeated = repeats_one_of(all.begin(), one);
    one = repeated ? all.erase(one) : one + 1;
    out += repeated ? 1 : 0;
  }
  return out;
}

}  // namespace tissue_stiffness
