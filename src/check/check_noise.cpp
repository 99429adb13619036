#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "check/check_motion.hpp"
#include "check/words.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTenfold = 10.0;
constexpr Eigen::Index kLeastRows = 30, kLeastFrames = 10, kMostFrames = 200;  // of a scatter
constexpr int kIntegrationSteps = 4000;

/// Returns the median of the Marchenko-Pastur distribution with ratio beta <= 1, by the midpoint rule. Its density is
/// proportional to sqrt((b - x)(x - a)) / x on [a, b] = (1 -+ sqrt(beta))^2.
double marchenko_pastur_median(double beta) {
  const double a = std::pow(1.0 - std::sqrt(beta), 2), b = std::pow(1.0 + std::sqrt(beta), 2);
  const double step = (b - a) / kIntegrationSteps;
  const auto density = [&](int i) {
    const double x = a + (i + 0.5) * step;
    return std::sqrt((b - x) * (x - a)) / x;
  };
  double whole = 0.0, part = 0.0;
  for (int i = 0; i < kIntegrationSteps; ++i) whole += density(i);
  int i = 0;
  while (part < 0.5 * whole) part += density(i++);
  return a + i * step;
}

/// Returns points with equal identities in every frame, a column for each frame, less their mean. It is empty where there
/// are too few.
Eigen::MatrixXd points_over_time(const std::vector<Frame>& frames, int source) {
  std::vector<const Observation*> seen;
  for (const Frame& frame : frames) {
    for (const Observation& observation : frame.observations) {
      const bool alike =
          seen.empty() || (observation.ids.size() == seen.front()->ids.size() && observation.ids == seen.front()->ids);
      if (observation.source == source && observation.ids.size() > 0 && alike) seen.push_back(&observation);
    }
  }
  const auto count = std::min(static_cast<Eigen::Index>(seen.size()), kMostFrames);
  if (count < kLeastFrames || seen.front()->points.size() < kLeastRows) return {};
  Eigen::MatrixXd matrix(seen.front()->points.size(), count);
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Matrix3Xd& points = seen[static_cast<std::size_t>(k)]->points;
    matrix.col(k) = Eigen::Map<const Eigen::VectorXd>(points.data(), points.size());
  }
  return matrix.colwise() - matrix.rowwise().mean();
}

/// Returns the root mean square of the rows of one source, in one frame or in all [m]; 0 where there is none.
double rms(const MotionStudy& study, const Eigen::VectorXd& rows, int source, int frame = -1) {
  double sum = 0.0, count = 0.0;
  for (Eigen::Index i = 0; i < rows.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    if (study.sources()[row] != source || (frame >= 0 && study.frames()[row] != frame)) continue;
    sum += rows[i] * rows[i];
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(sum / count) : 0.0;
}

double largest_motion(const MotionStudy& study, int source) {
  double largest = 0.0;
  const int frames = study.frames().empty() ? 0 : study.frames().back() + 1;
  for (int k = 0; k < frames; ++k) largest = std::max(largest, rms(study, study.measured(), source, k));
  return largest;
}

}  // namespace

double scatter(const Eigen::MatrixXd& matrix) {
  const Eigen::MatrixXd gram =
      matrix.rows() < matrix.cols() ? Eigen::MatrixXd(matrix * matrix.transpose()) : matrix.transpose() * matrix;
  const Eigen::VectorXd squares =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram, Eigen::EigenvaluesOnly).eigenvalues();
  const auto longer = static_cast<double>(std::max(matrix.rows(), matrix.cols()));
  const double median = std::max(squares[squares.size() / 2], 0.0);  // they ascend
  return std::sqrt(median / (longer * marchenko_pastur_median(static_cast<double>(squares.size()) / longer)));
}

SetupFindings check_noise(const MotionStudy& study, const ModelSettings& settings, const std::vector<Frame>& frames) {
  const Eigen::VectorXd residual = study.measured() - study.predicted(study.best_modulus());
  SetupFindings findings;
  for (std::size_t i = 0; i < settings.observations.size(); ++i) {
    const int source = static_cast<int>(i);
    const ObservationSettings& observation = settings.observations[i];
    const std::string key = "observations[" + std::to_string(i) + "].noise (" + observation.topic + "): ";
    const std::string stated = key + "the noise of " + millimetres(observation.noise);
    const double motion = largest_motion(study, source), left = rms(study, residual, source);
    const Eigen::MatrixXd points = points_over_time(frames, source);
    const double measured = points.size() > 0 ? scatter(points) : observation.noise;
    if (motion > 0.0 && observation.noise > motion) {
      findings.push_back(
          {key, stated + " is larger than the motion, which is " + millimetres(motion) +
                    " rms where it is largest and has to stand out; state the noise of one coordinate in m, 1 "
                    "sigma."});
    } else if (left > 0.0 && observation.noise > kTenfold * left) {
      findings.push_back({key, stated + " is " + plain_number(observation.noise / left, 2) +
                                   " times what the model leaves of the recording, " + millimetres(left) +
                                   " rms, and should be about that; state the noise of one coordinate in m, 1 sigma."});
    } else if (observation.noise * kTenfold < measured) {
      findings.push_back({key, stated + " is " + plain_number(measured / observation.noise, 2) +
                                   " times smaller than the recording's own scatter, " + millimetres(measured) +
                                   " rms, and should be about that; state the noise of one coordinate in m, 1 sigma."});
    }
  }
  return findings;
}

SetupFindings check_motion(const ModelSettings& settings, const TetMesh& mesh, const Recorded& recorded) {
  if (!MotionStudy::applies(settings) || recorded.frames.empty()) return {};
  const MotionStudy study(settings, mesh, recorded);
  SetupFindings findings = check_loads(study, settings);
  if (findings.empty()) findings = check_noise(study, settings, recorded.frames);  // a wrong load leaves a wrong residual
  return findings;
}

}  // namespace tissue_stiffness
