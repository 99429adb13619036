#include "estimation/map_stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>

#include "estimation/map_level.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/repeated_observation.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostFrames = 300;  // of a recording; longer ones are thinned
constexpr double kEvidence = 5.0;         // log evidence that a division must gain
constexpr double kSmall = 0.0025;         // of the noise's mean square: smaller gains are no sign of anything
constexpr double kUnassessed = 0.01;      // of the noise's mean square, where the mesh's error is not known

std::vector<Frame> usable(const std::vector<Frame>& frames, double rest) {
  std::vector<Frame> after, kept;
  for (const Frame& frame : frames) {
    if (frame.time >= rest) after.push_back(frame);
  }
  const std::size_t count = std::min(after.size(), kMostFrames);
  for (std::size_t k = 0; k < count; ++k) {
    kept.push_back(after[k * after.size() / count]);
    leave_out_repeats(kept.back());
  }
  return kept;
}

// Returns filter coordinates of what an estimator found, and of the prior for the rest.
Eigen::VectorXd coordinates(const Model& model, const Estimate& estimate) {
  std::map<std::string, double> values;
  for (const ParameterEstimate& p : estimate.parameters) values[p.name] = p.mean;
  return model.parameters().coordinates(values, model.parameters().prior_mean());
}

// Returns whether the fit gains more than the mesh may leave of a misfit, which patches would take up too.
bool better(const MapLevel& finer, MapLevel& kept) {
  const double gain = kept.mean_square() - finer.mean_square();
  if (gain <= kSmall) return false;
  const auto& answer = kept.mesh_study().answer;
  return gain > (answer ? answer->left : kUnassessed);
}

std::shared_ptr<MapLevel> first_level(const MapQuestion& question, const Model& base) {
  const std::vector<Patch> whole{mapped_tets(base)};
  const Eigen::VectorXd start = coordinates(base, question.estimate);
  const Eigen::Index modulus = with_patches(base, whole, Eigen::VectorXd::Zero(1)).first;
  return std::make_shared<MapLevel>(question, base, whole, start, start.segment(modulus, 1));
}

void paint(StiffnessMap& map, const std::vector<Patch>& patches, const TetMesh& mesh) {
  map.patch_of_tet.assign(static_cast<std::size_t>(mesh.tet_count()), -1);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(mesh.node_count()), count = sum;
  for (std::size_t r = 0; r < patches.size(); ++r) {
    for (const int tet : patches[r]) {
      map.patch_of_tet[static_cast<std::size_t>(tet)] = static_cast<int>(r);
      if (!map.patches[r].identified) continue;
      for (Eigen::Index k = 0; k < mesh.tets.rows(); ++k) {
        const int node = mesh.tets(k, tet);
        sum[node] += std::log(map.patches[r].young_modulus);
        count[node] += 1.0;
      }
    }
  }
  map.at_nodes = (sum.array() / count.array()).exp();  // 0/0: NaN where no patch is identified
}

std::shared_ptr<MapLevel> next_level(const MapQuestion& question, const Model& base, const MapLevel& last,
                                     const Division& finer) {
  const Eigen::VectorXd coarse = last.log_modulus();
  Eigen::VectorXd log_modulus(static_cast<Eigen::Index>(finer.parent.size()));
  for (Eigen::Index r = 0; r < log_modulus.size(); ++r) log_modulus[r] = coarse[finer.parent[static_cast<std::size_t>(r)]];
  return std::make_shared<MapLevel>(question, base, finer.patches, last.base_parameters(), log_modulus);
}

// Returns the finest patches, each with the modulus of the kept one that it lies in. Where the data do not determine it,
// the patch has what the smooth prior makes of its neighbours.
std::vector<StiffnessPatch> combined(MapLevel& kept, const MapLevel& finest, const std::vector<int>& kept_patch) {
  std::vector<StiffnessPatch> out = finest.describe(Eigen::VectorXd::Zero(finest.size()));
  const std::vector<StiffnessPatch> coarse = kept.describe(kept.mesh_shift());
  const std::vector<bool> seen = finest.seen();
  for (std::size_t r = 0; r < out.size(); ++r) {
    const StiffnessPatch& whole = coarse[static_cast<std::size_t>(kept_patch[r])];
    const Eigen::Vector3d center = out[r].center;
    const bool identified = seen[r] && whole.identified;
    if (identified) out[r] = whole;
    out[r].center = center;
    out[r].identified = identified;
  }
  return out;
}

}  // namespace

StiffnessMap map_stiffness(const MapQuestion& asked) {
  MapQuestion question = asked;
  question.frames = usable(asked.frames, asked.first_stamp + asked.settings.time.start);
  if (question.frames.empty()) throw InputError("map", "no frame", "at least one");
  const Model base(question.settings, question.mesh);
  StiffnessMap map;
  std::shared_ptr<MapLevel> last = first_level(question, base), kept = last;
  std::vector<int> kept_patch{0};  // kept patch that each patch of the last level lies in
  map.levels.push_back({1, last->mean_square(), 0.0, true});
  for (;;) {
    const auto count = static_cast<int>(last->patches().size());
    Division finer = divide_patches(base.mesh(), last->patches(), std::min(2 * count, question.settings.map->cells));
    if (static_cast<int>(finer.patches.size()) == count) break;
    last = next_level(question, base, *last, finer);
    for (int& parent : finer.parent) parent = kept_patch[static_cast<std::size_t>(parent)];
    kept_patch = finer.parent;
    StiffnessLevel level{static_cast<int>(finer.patches.size()), last->mean_square(), last->evidence_over(*kept), false};
    level.kept = level.log_evidence > kEvidence && better(*last, *kept);
    map.levels.push_back(level);
    if (!level.kept) continue;
    kept = last;
    std::iota(kept_patch.begin(), kept_patch.end(), 0);
  }
  map.patches = combined(*kept, *last, kept_patch);
  const MapLevel::MeshStudy& study = kept->mesh_study();
  map.mesh_error = study.why_not;
  map.misfit = std::sqrt(std::max(0.0, kept->mean_square() - (study.answer ? study.answer->left : 0.0)));
  for (StiffnessPatch& patch : map.patches) patch.identified = patch.identified && map.explains();
  paint(map, last->patches(), base.mesh());
  return map;
}

}  // namespace tissue_stiffness
