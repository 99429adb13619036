#include <algorithm>
#include <cmath>
#include <complex>
#include <map>
#include <numeric>

#include "diagnosis/residual_views.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kAmplitudeBins = 5, kPhaseBins = 8;
constexpr Eigen::Index kMostRows = 600;  // rows of a frame that the spectrum takes
constexpr int kMostFrequencies = 120;
constexpr double kPi = 3.14159265358979323846;

struct Frames {
  Eigen::VectorXd time, square, count, motion;  ///< motion: rms since the first frame [m]; NaN where rows differ
};

Frames by_frame(const RecordingFit& recording_fit, const RecordingRows& rows) {
  const Eigen::Index n = rows.frames.count();
  Frames out{Eigen::VectorXd(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), Eigen::VectorXd(n)};
  const Eigen::Index first = rows.frames.before(1);
  Eigen::VectorXd metres = rows.predicted.cwiseProduct(rows.sigma);
  for (Eigen::Index r = 0; r < metres.size(); ++r) {
    if (!rows.tells_length(r)) metres[r] = 0.0;
  }
  for (Eigen::Index t = 0; t < n; ++t) {
    const auto [from, size] = rows.frames[t];
    const Recording& recording = recording_fit.recording();
    out.time[t] = recording.frames[static_cast<std::size_t>(t)].time - recording.first_stamp;
    out.square[t] = rows.error.segment(from, size).squaredNorm();
    out.count[t] = static_cast<double>((rows.used.segment(from, size).array() > 0.0).count());
    out.motion[t] = size == first && first > 0
                        ? (metres.segment(from, size) - metres.head(first)).norm() / std::sqrt(static_cast<double>(first))
                        : std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

double rms(double square, double count) {
  return count > 0.0 ? std::sqrt(square / count) : std::numeric_limits<double>::quiet_NaN();
}

void places(const RecordingRows& rows, ResidualViews& out) {
  std::map<int, std::pair<double, double>> sums;
  for (Eigen::Index r = 0; r < rows.error.size(); ++r) {
    if (!rows.tells_length(r)) continue;
    sums[rows.nodes[r]].first += rows.error[r] * rows.error[r];
    sums[rows.nodes[r]].second += 1.0;
  }
  for (const auto& [node, sum] : sums) {
    out.nodes.push_back(node);
    out.node_rms.push_back(rms(sum.first, sum.second));
  }
}

void amplitudes(const Frames& frames, ResidualViews& out) {
  std::vector<Eigen::Index> order(static_cast<std::size_t>(frames.motion.size()));
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return frames.motion[a] < frames.motion[b]; });
  for (int bin = 0; bin < kAmplitudeBins; ++bin) {
    const std::size_t from = order.size() * static_cast<std::size_t>(bin) / kAmplitudeBins;
    const std::size_t to = order.size() * static_cast<std::size_t>(bin + 1) / kAmplitudeBins;
    double square = 0.0, count = 0.0;
    for (std::size_t i = from; i < to; ++i) square += frames.square[order[i]], count += frames.count[order[i]];
    out.amplitude.push_back(frames.motion[order[to - 1]]);
    out.amplitude_rms.push_back(rms(square, count));
  }
}

// Returns the sum over rows of |Fourier transform|^2 at each frequency, of the rows' deviations from their means.
Eigen::VectorXd spectrum(const Eigen::VectorXd& values, const RecordingRows& rows, const Eigen::VectorXd& time,
                         const std::vector<double>& frequency) {
  const Eigen::Index n = time.size(), size = rows.frames.before(1), stride = std::max<Eigen::Index>(1, size / kMostRows);
  const Eigen::Index kept = (size + stride - 1) / stride;
  Eigen::MatrixXd series(n, kept);
  for (Eigen::Index t = 0; t < n; ++t) {
    for (Eigen::Index r = 0; r < kept; ++r) series(t, r) = values[rows.frames.before(t) + r * stride];
  }
  series.rowwise() -= series.colwise().mean().eval();
  Eigen::VectorXd power(static_cast<Eigen::Index>(frequency.size()));
  for (Eigen::Index k = 0; k < power.size(); ++k) {
    const Eigen::ArrayXd angle = 2.0 * kPi * frequency[static_cast<std::size_t>(k)] * time.array();
    const Eigen::RowVectorXd c = angle.cos().matrix().transpose() * series, s = angle.sin().matrix().transpose() * series;
    power[k] = c.squaredNorm() + s.squaredNorm();
  }
  return power;
}

void frequencies(const RecordingRows& rows, const Frames& frames, ResidualViews& out) {
  const Eigen::Index n = frames.time.size();
  const double duration = frames.time[n - 1] - frames.time[0];
  const int count = std::min(kMostFrequencies, static_cast<int>(n / 2));
  for (int k = 1; k <= count; ++k) out.frequency.push_back(k / duration);
  const Eigen::VectorXd error = spectrum(rows.error, rows, frames.time, out.frequency);
  const double total = error.sum();
  for (Eigen::Index k = 0; k < error.size(); ++k) out.power.push_back(total > 0.0 ? error[k] / total : 0.0);
  const Eigen::VectorXd motion = spectrum(rows.predicted, rows, frames.time, out.frequency);
  Eigen::Index strongest = 0;
  motion.maxCoeff(&strongest);
  std::vector<double> square(kPhaseBins, 0.0), counted(kPhaseBins, 0.0);
  for (Eigen::Index t = 0; t < n; ++t) {
    const double cycles = frames.time[t] * out.frequency[static_cast<std::size_t>(strongest)];
    const auto bin = static_cast<std::size_t>(kPhaseBins * (cycles - std::floor(cycles))) % kPhaseBins;
    square[bin] += frames.square[t];
    counted[bin] += frames.count[t];
  }
  for (std::size_t bin = 0; bin < kPhaseBins; ++bin) {
    out.phase.push_back(2.0 * kPi * (static_cast<double>(bin) + 0.5) / kPhaseBins);
    out.phase_rms.push_back(rms(square[bin], counted[bin]));
  }
}

}  // namespace

ResidualViews residual_views(const RecordingFit& recording_fit, const RecordingRows& rows) {
  ResidualViews out;
  const Frames frames = by_frame(recording_fit, rows);
  for (Eigen::Index t = 0; t < frames.time.size(); ++t) {
    out.time.push_back(frames.time[t]);
    out.frame_rms.push_back(rms(frames.square[t], frames.count[t]));
  }
  places(rows, out);
  if (!frames.motion.allFinite()) return out;
  amplitudes(frames, out);
  frequencies(rows, frames, out);
  return out;
}

}  // namespace tissue_stiffness
