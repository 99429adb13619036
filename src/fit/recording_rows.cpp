#include "fit/recording_rows.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

// Returns the root mean square of a value [m] over the rows of lengths that `counts` takes.
template <typename Counts, typename Value>
double rms_of_lengths(const RecordingRows& rows, const Counts& counts, const Value& value) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index k = 0; k < rows.frames.count(); ++k) {
    if (!counts(static_cast<std::size_t>(k))) continue;
    const auto range = rows.frames[k];
    for (Eigen::Index r = range.from; r < range.end(); ++r) {
      if (!rows.tells_length(r)) continue;
      sum += std::pow(value(r), 2);
      count += 1.0;
    }
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

}  // namespace

RecordingRows recording_rows(const std::vector<Prediction>& predictions) {
  RecordingRows out;
  for (const Prediction& p : predictions) out.frames.append(p.measured.size());
  const Eigen::Index count = out.frames.total();
  for (Eigen::VectorXd* v : {&out.error, &out.predicted, &out.used, &out.sigma}) *v = Eigen::VectorXd::Zero(count);
  out.nodes = Eigen::VectorXi::Zero(count);
  out.places = Eigen::Matrix3Xd::Zero(3, count);
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const Prediction& p = predictions[k];
    const Eigen::VectorXd weight = row_weights(p);
    const Eigen::Index from = out.frames.before(static_cast<Eigen::Index>(k));
    out.places.middleCols(from, p.places.cols()) = p.places;
    for (Eigen::Index i = 0; i < p.measured.size(); ++i) {
      const Eigen::Index row = from + i;
      if (!(weight[i] > 0.0) || !std::isfinite(p.sigma[i])) continue;
      out.sigma[row] = p.sigma[i];
      out.nodes[row] = p.nodes[i];
      out.used[row] = std::sqrt(weight[i]);
      out.predicted[row] = p.predicted[i] / p.sigma[i];
      out.error[row] = out.used[row] * (p.measured[i] - p.predicted[i]) / p.sigma[i];
    }
  }
  return out;
}

Eigen::VectorXd motion_of(const RecordingRows& rows) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(rows.predicted.size());
  const Eigen::Index first = rows.frames.before(1);
  for (Eigen::Index k = 0; k < rows.frames.count(); ++k) {
    const auto [from, size] = rows.frames[k];
    if (size == first) out.segment(from, size) = rows.predicted.segment(from, size) - rows.predicted.head(first);
  }
  return out;
}

double structured_squares(const RecordingRows& rows) {
  return std::max(0.0, rows.error.squaredNorm() - rows.count());
}

double rms_error(const RecordingRows& rows, const Recording& recording, bool held_out) {
  return rms_of_lengths(
      rows, [&](std::size_t frame) { return recording.held_out(frame) == held_out; },
      [&](Eigen::Index r) { return rows.sigma[r] * rows.error[r]; });
}

double rms_error(const RecordingRows& rows) {
  return rms_of_lengths(
      rows, [](std::size_t) { return true; }, [&](Eigen::Index r) { return rows.sigma[r] * rows.error[r]; });
}

double noise_floor(const RecordingRows& rows) {
  return rms_of_lengths(
      rows, [](std::size_t) { return true; }, [&](Eigen::Index r) { return rows.sigma[r]; });
}

}  // namespace tissue_stiffness
