#include "diagnosis/residual_views.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

#include "types/formatted.hpp"
#include "types/plain_number.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLocal = 2.0;   // times the body's mean excess: a place that stands out
constexpr double kAbove = 1.2;   // rms in sigmas above which an error is more than noise
constexpr double kInside = 0.8;  // of the nodes that stand out: they lie in a region
constexpr double kGrows = 0.5;   // correlation of error and motion over frames

// Returns the mean square error in sigmas of each mesh node that was seen.
std::map<int, double> node_errors(const RecordingRows& rows) {
  std::map<int, std::pair<double, double>> sums;
  for (Eigen::Index r = 0; r < rows.error.size(); ++r) {
    if (!rows.tells_length(r)) continue;
    sums[rows.nodes[r]].first += rows.error[r] * rows.error[r];
    sums[rows.nodes[r]].second += 1.0;
  }
  std::map<int, double> errors;
  for (const auto& [node, sum] : sums) errors[node] = sum.first / sum.second;
  return errors;
}

std::string region_around(const RecordingFit& recording_fit, const std::vector<int>& nodes) {
  for (const auto& [name, region] : recording_fit.model().body().regions) {
    const auto inside = std::count_if(nodes.begin(), nodes.end(), [&own = region.nodes](int node) {
      return std::binary_search(own.begin(), own.end(), node);
    });
    if (static_cast<double>(inside) > kInside * static_cast<double>(nodes.size())) return ", in region " + name;
  }
  return "";
}

}  // namespace

std::string where_it_fails(const RecordingFit& recording_fit, const RecordingRows& rows) {
  const std::map<int, double> errors = node_errors(rows);
  double mean = 0.0;
  for (const auto& [node, error] : errors) mean += error / static_cast<double>(errors.size());
  if (mean < kAbove * kAbove) return formatted("nowhere: %.2f sigma rms over the body", std::sqrt(mean));
  std::vector<int> worst;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (const auto& [node, error] : errors) {
    if (error - 1.0 < kLocal * (mean - 1.0)) continue;
    worst.push_back(node);
    centre += (error - 1.0) * recording_fit.model().mesh().nodes.col(node);
    weight += error - 1.0;
  }
  if (worst.empty()) return formatted("all over the body, %.1f sigma rms", std::sqrt(mean));
  centre /= weight;
  double square = 0.0;
  for (const int node : worst) square += errors.at(node) / static_cast<double>(worst.size());
  return "around " + position_in_millimetres(centre) + " mm" + region_around(recording_fit, worst) +
         formatted(": %.1f sigma rms there, %.1f over the body", std::sqrt(square), std::sqrt(mean));
}

std::string when_it_fails(const RecordingFit& recording_fit, const RecordingRows& rows) {
  const Eigen::Index frames = rows.frames.count();
  Eigen::VectorXd error(frames), motion(frames);
  for (Eigen::Index t = 0; t < frames; ++t) {
    const auto [from, count] = rows.frames[t];
    const Eigen::Index first = std::min(rows.frames.before(1), count);
    error[t] = rows.error.segment(from, count).squaredNorm() / static_cast<double>(std::max<Eigen::Index>(count, 1));
    motion[t] = (rows.predicted.segment(from, first) - rows.predicted.head(first)).norm();
  }
  const double start = recording_fit.recording().first_stamp;
  Eigen::Index worst = 0;
  error.maxCoeff(&worst);
  const auto third = [&](Eigen::Index k) {
    const Eigen::Index from = k * frames / 3, to = (k + 1) * frames / 3;
    return error.segment(from, to - from).sum() / error.sum();
  };
  std::string text = formatted("%.0f, %.0f and %.0f %% of it in the first, second and last third", 100.0 * third(0),
                               100.0 * third(1), 100.0 * third(2));
  text +=
      formatted("; largest at %.2f s (%.1f sigma)",
                recording_fit.recording().frames[static_cast<std::size_t>(worst)].time - start, std::sqrt(error[worst]));
  const Eigen::ArrayXd e = error.cwiseSqrt().array() - error.cwiseSqrt().mean(), m = motion.array() - motion.mean();
  const double correlation = (e * m).sum() / std::sqrt(e.square().sum() * m.square().sum());
  if (correlation > kGrows) text += "; grows with the displacement";
  return text;
}

std::string next_experiment(const std::vector<std::string>& set, const BestExplanation& best) {
  std::vector<std::string> alike = others_in_set(set, best);
  if (alike.empty() || best.effects.empty()) return "";
  alike.insert(alike.begin(), best.effects.front());
  struct Hint {
    const char *a, *b, *experiment;
  };
  static const std::vector<Hint> hints{
      {"mass_damping", "viscous_damping", "excite two modes: mass damping dies in high ones, viscous damping in low ones"},
      {"viscous_damping", "viscoelasticity", "hold a constant load for several seconds: only viscoelasticity creeps"},
      {"mass_damping", "viscoelasticity", "hold a constant load for several seconds: only viscoelasticity creeps"},
      {"added_mass", "image_scale", "a static load: a scale changes it, a mass without gravity does not"},
      {"density_error", "force_scale", "weigh the body: no motion tells density from force"},
      {"elastic_support", "image_scale", "track points close to the support: only a yielding support moves them"},
      {"fibre_reinforcement", "stiff_inclusion", "load along and across the fibres"},
      {"gravity", "rigid_drift", "turn the body, or keep the sensor still on a fixed target"},
      {"gravity", "sensor_rotation", "load the body along another axis: a turned sensor turns that motion, too"},
      {"geometric_nonlinearity", "strain_stiffening", "a load twice as large: stiffening grows faster"},
  };
  for (const Hint& hint : hints) {
    const bool has_a = std::find(alike.begin(), alike.end(), hint.a) != alike.end();
    const bool has_b = std::find(alike.begin(), alike.end(), hint.b) != alike.end();
    if (has_a && has_b) return hint.experiment;
  }
  return "another load: a second direction, or half and twice the force, with points tracked near supports and loads; " +
         alike[0] + " and " + alike[1] + " scale differently with it";
}

}  // namespace tissue_stiffness
