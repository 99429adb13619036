#include "estimation/change_watch.hpp"

#include <algorithm>

namespace tissue_stiffness {
namespace {

constexpr int kFewest = 8;                        // frames before which nothing is suspected
constexpr double kRecent = 4.0, kAverage = 15.0;  // frames that the averages remember
constexpr double kRise = 1.5;                     // of the best misfit: a suspicious level

}  // namespace

void ChangeWatch::add(double square, const PosteriorLinearizationFilter& filter) {
  if (!drifts_) return;
  ++frames_;
  recent_ += (square - recent_) / std::min<double>(frames_, kRecent);
  average_ += (square - average_) / std::min<double>(frames_, kAverage);
  if (frames_ > kFewest) least_ = least_ > 0.0 ? std::min(least_, average_) : average_;
  if (risen()) {
    ++suspicious_;
    return;
  }
  suspicious_ = 0;
  next_ = kSearchEvery;
  steady_ = ChangeQuestion{filter.mean(), filter.covariance(), usual(), {}};
}

bool ChangeWatch::risen() const {
  return (frames_ > kFewest || least_ > 0.0) && recent_ > kRise * usual();
}

double ChangeWatch::usual() const {
  return std::max(1.0, least_);
}

std::optional<ChangeQuestion> ChangeWatch::due() {
  if (!steady_ || suspicious_ < next_) return std::nullopt;
  next_ = suspicious_ + std::max(kSearchEvery, suspicious_ / 2);
  return steady_;
}

void ChangeWatch::restart() {
  *this = ChangeWatch(drifts_);
}

void ChangeWatch::go_on() {
  const double least = least_;
  restart();
  least_ = least;
}

}  // namespace tissue_stiffness
