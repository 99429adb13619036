#include "diagnosis/missing_force.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "forward/reduced_trajectory.hpp"
#include "meshing/farthest_nodes.hpp"
#include "types/formatted.hpp"
#include "types/plain_number.hpp"
#include "types/two_digits.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLikelier = 10.0;   // fall of the deviance that a force must bring
constexpr std::size_t kNodes = 120;  // nodes of the surface at which the force is told
constexpr double kSameSpan = 1e-6;   // relative difference of spans that count as one
constexpr double kShortest = 1e-9;   // [s]
constexpr double kLocal = 0.5;       // share of the largest force per mass: a node with more counts

// Returns the corners of the facets, without the nodes between them.
std::vector<int> surface_corners(const TetMesh& mesh) {
  std::set<int> surface;
  for (Eigen::Index f = 0; f < mesh.facets.cols(); ++f) {
    for (Eigen::Index i = 0; i < 3; ++i) surface.insert(mesh.facets(i, f));
  }
  return {surface.begin(), surface.end()};
}

Eigen::Matrix3Xd at(const std::vector<int>& nodes, const Eigen::VectorXd& field) {
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>(nodes.size()));
  for (std::size_t i = 0; i < nodes.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = field.segment<3>(3 * nodes[i]);
  return out;
}

/// Returns the share of y's square, modes x frames, that is proportional to x, mode by mode.
double share_along(const Eigen::MatrixXd& y, const Eigen::MatrixXd& x) {
  double sum = 0.0;
  for (Eigen::Index i = 0; i < y.rows(); ++i) {
    sum += std::pow(y.row(i).dot(x.row(i)), 2) / std::max(x.row(i).squaredNorm(), 1e-300);
  }
  return sum / y.squaredNorm();
}

std::string in_words(const MissingForce& force) {
  std::size_t worst = 0;
  for (std::size_t k = 1; k < force.total.size(); ++k) {
    if (force.at_nodes[k].squaredNorm() > force.at_nodes[worst].squaredNorm()) worst = k;
  }
  const Eigen::Matrix3Xd& there = force.at_nodes[worst];
  const Eigen::VectorXd size = there.colwise().norm();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), mean = Eigen::Vector3d::Zero();
  double weight = 0.0;
  for (Eigen::Index i = 0; i < size.size(); ++i) {
    if (size[i] < kLocal * size.maxCoeff()) continue;
    centre += size[i] * force.places.col(i);
    mean += there.col(i);
    weight += size[i];
  }
  centre /= weight;
  mean.normalize();
  const auto most = std::max_element(force.follows.begin(), force.follows.end(),
                                     [](const auto& a, const auto& b) { return a.second < b.second; });
  return formatted(
      "up to %s N/kg, around %s mm along (%.2f, %.2f, %.2f), %s N on the whole body, at %.2f s; %.0f %% of it %s",
      two_digits(size.maxCoeff()).c_str(), position_in_millimetres(centre).c_str(), mean.x(), mean.y(), mean.z(),
      two_digits(force.total[worst].norm()).c_str(), force.time[worst], 100.0 * most->second,
      most->first == "constant" ? "is constant" : ("follows the " + most->first).c_str());
}

/// These are the body's lowest modes, and how the free run moves them.
struct Modes {
  Eigen::MatrixXd shapes;                    ///< 3n x modes, mass-normalised [kg^-1/2]
  Eigen::VectorXd square;                    ///< omega^2 [rad^2/s^2]
  Eigen::MatrixX3d weight;                   ///< modal force of a unit acceleration along each axis
  std::vector<double> spans;                 ///< before each frame [s]
  std::vector<ModalTransition> transitions;  ///< to each frame
  Eigen::MatrixXd displacement;              ///< modes x frames
  /// Returns the root mean square of the forces that move the modes.
  double scale() const {
    return std::sqrt((square.asDiagonal() * displacement).squaredNorm() / static_cast<double>(displacement.size()));
  }
};

Modes modes_of(const RecordingFit& recording_fit, const Eigen::VectorXd& w) {
  const auto reduced = recording_fit.reduced();
  const Eigen::VectorXd theta = recording_fit.model().parameters().theta(w);
  double time = recording_fit.recording().first_stamp + recording_fit.model().settings().time.start;
  ReducedTrajectory run(*reduced, theta, time);
  const Eigen::Index all = run.frequencies().size(), count = std::min<Eigen::Index>(most_force_modes, all);
  Modes out;
  out.shapes = run.mode_shapes(static_cast<int>(count));
  out.square = run.frequencies().head(count).cwiseAbs2();
  out.weight = reduced->modes(theta)->weight.topRows(count);
  const auto frames = static_cast<Eigen::Index>(recording_fit.recording().frames.size());
  out.displacement.resize(count, frames);
  double last = 0.0;
  for (Eigen::Index k = 0; k < frames; ++k) {
    const double next = recording_fit.recording().frames[static_cast<std::size_t>(k)].time;
    run.advance(next);
    const double span = std::max(next - time, kShortest);
    out.spans.push_back(span);
    if (k > 0 && std::abs(span - last) < kSameSpan * span) {
      out.transitions.push_back(out.transitions.back());
    } else {
      out.transitions.emplace_back(run.step(), span, count, all);
      last = span;
    }
    out.displacement.col(k) = run.modal_displacement().head(count);
    time = next;
  }
  return out;
}

double squares(const FrameEvidence& e, const Eigen::VectorXd& q) {
  return e.square - 2.0 * e.seen.dot(q) + q.dot(e.information * q);
}

// `along` holds the rows per displacement of each mode.
std::vector<FrameEvidence> evidence_of(const Eigen::VectorXd& error, const Eigen::MatrixXd& along, const FrameRows& frames,
                                       double variance) {
  std::vector<FrameEvidence> out;
  for (Eigen::Index k = 0; k < frames.count(); ++k) {
    const auto [from, size] = frames[k];
    const auto h = along.middleRows(from, size);
    const auto e = error.segment(from, size);
    out.push_back({h.transpose() * h / variance, h.transpose() * e / variance, e.squaredNorm() / variance});
  }
  return out;
}

}  // namespace

MissingForce missing_force(const RecordingFit& recording_fit, const Eigen::VectorXd& w) {
  const Recording& recording = recording_fit.recording();
  const TetMesh& mesh = recording_fit.model().mesh();
  const Modes modes = modes_of(recording_fit, w);
  const RecordingRows rows = recording_fit.rows(w);
  const std::vector<FrameEvidence> evidence =
      evidence_of(rows.error, recording_fit.rows_along(w, modes.shapes, rows), rows.frames, 1.0);
  const ForcePrior prior = likeliest_force_prior(modes.transitions, evidence, modes.scale());
  const SmoothedForce best = smooth_force(modes.transitions, evidence, prior);
  const double without = rows.error.squaredNorm();
  MissingForce out;
  if (!(best.deviance < without - kLikelier)) return out;

  const Eigen::Index count = modes.shapes.cols(), frames = modes.displacement.cols();
  out.parameters = recording_fit.model().parameters().values(w);
  out.nodes = farthest_nodes(mesh, surface_corners(mesh), kNodes);
  out.places = at(out.nodes, Eigen::Map<const Eigen::VectorXd>(mesh.nodes.data(), mesh.nodes.size()));
  Eigen::MatrixXd force(count, frames), q(count, frames), v(count, frames);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(count);
  double left = 0.0;
  Eigen::Index kept = 0;
  for (Eigen::Index k = 0; k < frames; ++k) {
    const auto frame = static_cast<std::size_t>(k);
    left += squares(evidence[frame], best.displacement[frame]);
    const Eigen::VectorXd now = modes.displacement.col(k) + best.displacement[frame];
    const double span = modes.spans[frame];
    if (k > 0 && span > kShortest) {
      force.col(kept) = best.force[frame - 1];  // which acts until this frame
      q.col(kept) = 0.5 * (before + now);
      v.col(kept) = (now - before) / span;
      out.time.push_back(recording.frames[frame].time - recording.first_stamp);
      out.total.emplace_back(modes.weight.transpose() * force.col(kept));
      out.at_nodes.push_back(at(out.nodes, modes.shapes * force.col(kept)));
      ++kept;
    }
    before = now;
  }
  force = modes.square.cwiseSqrt().cwiseInverse().asDiagonal() * force.leftCols(kept).eval();  // squared: static work
  out.explained = 1.0 - left / without;
  out.follows = {{"constant", share_along(force, Eigen::MatrixXd::Ones(count, kept))},
                 {"displacement", share_along(force, q.leftCols(kept))},
                 {"velocity", share_along(force, v.leftCols(kept))}};
  out.words = in_words(out);
  return out;
}

RandomForce::RandomForce(const FittedModel& model) {
  const Modes modes = modes_of(*model.recording_fit, model.fit.w);
  transitions = modes.transitions;
  along = model.recording_fit->rows_along(model.fit.w, modes.shapes, model.rows);
  scale = modes.scale();
}

Eigen::VectorXd log_evidence_gained(const RandomForce& force, const Assessment& alone, const ModelComparison& comparison) {
  const double s = comparison.noise_variance(), tried = log_of_tried_priors(force.along.cols());
  Eigen::MatrixXd rows(alone.left.size(), 1 + force.along.cols());
  rows << alone.left, force.along;
  return comparison.by_mesh_error(comparison.along_modes(rows), [&](const Eigen::MatrixXd& along) {
    const std::vector<FrameEvidence> evidence =
        evidence_of(along.col(0), along.rightCols(along.cols() - 1), comparison.modal_frames(), s);
    const ForcePrior prior = likeliest_force_prior(force.transitions, evidence, force.scale);
    const double without = along.col(0).squaredNorm() / s;
    return 0.5 * (without - smooth_force(force.transitions, evidence, prior).deviance) - tried;
  });
}

}  // namespace tissue_stiffness
