#include "diagnosis/belief_map.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "diagnosis/scores.hpp"
#include "meshing/farthest_nodes.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kParts = 12;
constexpr std::size_t kNodesOfAPart = 3;  // at least
constexpr double kLeast = 0.1, kMost = 100.0;
constexpr int kExcesses = 16;

// Returns for each row that says something the part that it sees, else -1.
std::vector<int> part_rows(const TetMesh& mesh, const RecordingRows& rows, BeliefMap& out) {
  std::map<int, int> part_of;  // nearest centre of each node that is seen
  for (Eigen::Index r = 0; r < rows.error.size(); ++r) {
    if (rows.tells_length(r)) part_of[rows.nodes[r]] = 0;
  }
  for (const auto& [node, part] : part_of) out.nodes.push_back(node);
  const std::size_t most = std::clamp<std::size_t>(out.nodes.size() / kNodesOfAPart, 1, kParts);
  const std::vector<int> centres = farthest_nodes(mesh, out.nodes, most);
  out.centres.resize(3, static_cast<Eigen::Index>(centres.size()));
  for (std::size_t p = 0; p < centres.size(); ++p)
    out.centres.col(static_cast<Eigen::Index>(p)) = mesh.nodes.col(centres[p]);
  for (auto& [node, part] : part_of) {
    Eigen::Index nearest = 0;
    (out.centres.colwise() - mesh.nodes.col(node)).colwise().squaredNorm().minCoeff(&nearest);
    part = static_cast<int>(nearest);
    out.parts.push_back(part);
  }
  std::vector<int> seen;
  for (Eigen::Index r = 0; r < rows.error.size(); ++r) {
    seen.push_back(rows.tells_length(r) ? part_of.at(rows.nodes[r]) : -1);
  }
  return seen;
}

// The noise is taken from the whole body.
double probability(const MisfitTest& here, const MisfitTest& whole) {
  if (!(here.structured_dof() > 0.0)) return 0.5;
  const double square = whole.lag1_autocorrelation() * whole.lag1_autocorrelation(),
               independent = (1.0 - square) / (1.0 + square);
  const double freedom = independent * here.structured_dof(), mean_square = here.excess() + here.noise_level();
  return 1.0 / (1.0 + std::exp(log_evidence_of_excess(freedom * mean_square / whole.noise_level(), freedom)));
}

}  // namespace

double log_evidence_of_excess(double x, double degrees_of_freedom) {
  std::vector<double> terms;
  for (int k = 0; k < kExcesses; ++k) {
    const double g = kLeast * std::pow(kMost / kLeast, k / (kExcesses - 1.0));
    terms.push_back(0.5 * (x * g / (1.0 + g) - degrees_of_freedom * std::log1p(g)));
  }
  return log_mean_exp(terms);
}

BeliefMap belief_map(const FittedModel& model, const Eigen::VectorXd& left, const ModelComparison& comparison) {
  BeliefMap out;
  const RecordingRows& rows = model.rows;
  const std::vector<int> seen = part_rows(model.recording_fit->model().mesh(), rows, out);
  if (out.nodes.empty()) return out;
  const Eigen::VectorXd white = comparison.whitened(left);
  const MisfitTest whole = comparison.test_of(white, 0.0);
  const Eigen::Index frames = rows.frames.count();
  out.probability.resize(out.centres.cols(), 3);
  for (Eigen::Index part = 0; part < out.probability.rows(); ++part) {
    const auto inside = [&](Eigen::Index row) { return seen[static_cast<std::size_t>(row)] == part; };
    for (Eigen::Index third = 0; third < 3; ++third) {
      out.probability(part, third) =
          probability(comparison.test_where(white, third * frames / 3, (third + 1) * frames / 3, inside), whole);
    }
  }
  return out;
}

}  // namespace tissue_stiffness
