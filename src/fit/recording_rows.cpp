#include "fit/recording_rows.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

// Returns the root mean square of a value [m] over the rows of lengths that `counts` takes.
template <typename Counts, typename Value>
double rms_of_lengths(const RecordingRows& rows, const Counts& counts, const Value& value) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k + 1 < rows.offsets.size(); ++k) {
    if (!counts(k)) continue;
    for (Eigen::Index r = rows.offsets[k]; r < rows.offsets[k + 1]; ++r) {
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
  out.offsets.push_back(0);
  for (const Prediction& p : predictions) out.offsets.push_back(out.offsets.back() + p.measured.size());
  for (Eigen::VectorXd* v : {&out.error, &out.predicted, &out.used, &out.sigma})
    *v = Eigen::VectorXd::Zero(out.offsets.back());
  out.nodes = Eigen::VectorXi::Zero(out.offsets.back());
  out.places = Eigen::Matrix3Xd::Zero(3, out.offsets.back());
  for (std::size_t k = 0; k < predictions.size(); ++k) {
    const Prediction& p = predictions[k];
    const Eigen::VectorXd weight = row_weights(p);
    out.places.middleCols(out.offsets[k], p.places.cols()) = p.places;
    for (Eigen::Index i = 0; i < p.measured.size(); ++i) {
      const Eigen::Index row = out.offsets[k] + i;
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
  const Eigen::Index first = rows.offsets[1];
  for (std::size_t k = 0; k + 1 < rows.offsets.size(); ++k) {
    const Eigen::Index from = rows.offsets[k], size = rows.offsets[k + 1] - from;
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
