#include "estimation/input_models.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <string>
#include <utility>

#include "effects/registry.hpp"
#include "estimation/basis_error.hpp"
#include "meshing/offset_surface.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kOffset = 0.5;       // of a tolerance: how far the surface is moved
constexpr double kMostOffset = 0.05;  // of the shortest edge: at most so far, as nothing inside moves

// A known Poisson's ratio is folded into one matrix; a model in which it is free keeps it apart.
ModelSettings with_free_ratio(ModelSettings settings) {
  for (EffectSettings& effect : settings.effects) {
    if (effect.name != "elasticity") continue;
    const Quantity ratio = read_parameters(effect)[1];
    if (ratio.estimated() || !(ratio.tolerance > 0.0)) continue;
    std::vector<std::pair<std::string, Value>> entries;
    const std::string path = effect.arguments.path();
    for (const std::string& key : effect.arguments.keys()) {
      entries.emplace_back(key, key != "poisson_ratio" ? effect.arguments.at(key)
                                                       : Value::map({{"mean", Value::number(ratio.value, path)},
                                                                     {"std", Value::number(ratio.tolerance, path)}},
                                                                    path));
    }
    effect.arguments = Value::map(std::move(entries), path);
  }
  return settings;
}

// Returns the rigid translations along, and rotations about, each axis through the body's middle, 3n x 6.
Eigen::MatrixXd rigid_motions(const TetMesh& mesh) {
  const Eigen::Vector3d middle = mesh.nodes.rowwise().mean();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(mesh.nodes.size(), 6);
  for (Eigen::Index a = 0; a < mesh.nodes.cols(); ++a) {
    for (int i = 0; i < 3; ++i) {
      out(3 * a + i, i) = 1.0;
      out.block<3, 1>(3 * a, 3 + i) = Eigen::Vector3d::Unit(i).cross(mesh.nodes.col(a) - middle);
    }
  }
  return out;
}

}  // namespace

OffsetBody::OffsetBody(const Model& body, double tolerance)
    : tolerances(std::min(kOffset, kMostOffset * shortest_edge(body.mesh()) / tolerance)),
      model(body.settings(), offset_surface(body.mesh(), tolerances * tolerance), body.body().regions),
      runs(make_study_model(model)) {}

void OffsetBody::drive_like(const Model& body) {
  for (const auto& [topic, course] : body.loads().courses()) *model.loads().courses().at(topic) = *course;
  model.loads().set_first_stamp(body.loads().first_stamp());
}

InputModels::InputModels(const Model& model)
    : base(model.settings(), model),
      uncertain(with_free_ratio(model.settings()), model),
      operators(make_observation_operators(base)),
      constants(model.parameters().uncertain_constants()),
      rigid(rigid_motions(base.mesh())) {
  runs = make_study_model(uncertain);
  const double tolerance = base.settings().exact_inputs ? 0.0 : base.settings().mesh.surface_tolerance;
  if (!(tolerance > 0.0)) return;
  offset = std::make_unique<OffsetBody>(uncertain, tolerance);
  constants.push_back({"mesh.surface", UncertainConstant::surface, 0.0, tolerance});
}

void InputModels::grow_basis(const MeshError::Question& question) {
  const auto* reduced = dynamic_cast<const ReducedModel*>(runs.get());
  if (reduced == nullptr || !studied_in_full(base)) return;
  const FitProblem problem{base, *reduced, operators, question.frames, {question.start}, question.checkpoint};
  BasisGrowth growth = tissue_stiffness::grow_basis(*reduced, exhausted, problem, question.w, surface_nodes(base.mesh()));
  exhausted = growth.exhausted;
  if (growth.larger) runs = std::move(growth.larger);
}

}  // namespace tissue_stiffness
