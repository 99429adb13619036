#include "tools/estimated_model.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>

#include "nodes/estimator_inputs.hpp"
#include "report/map_vtk.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/stiffness_map.hpp"
#include "tools/recording_reader.hpp"
#include "types/read_table.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

std::string existing(const std::string& given, const std::string& recorded, const std::string& results,
                     const std::string& key) {
  const std::string& file = given.empty() ? recorded : given;
  if (fs::exists(file)) return file;
  throw InputError(given.empty() ? results + ": " + key : "--" + key, file + ", which is not there",
                   "the folder that `estimate` ran in, or --" + key + " FILE");
}

/// Mesh and loads of a recording, read as far as the model needs it.
struct Drive {
  TetMesh mesh;
  double first_stamp = 0.0;
  std::vector<LoadSample> loads;
};

// Images matter only for the mesh, so the loads are read with as few of them as possible.
Drive read_drive(const ModelSettings& settings, const SavedResults& results, const std::string& recording) {
  const bool loaded = !load_topics(settings).empty(), meshed = settings.mesh.source == MeshSettings::Source::file;
  Drive out;
  if (!loaded && meshed) return {build_mesh(settings.mesh), 0.0, {}};
  const std::string bag = existing(recording, results.recording, results.file, "recording");
  if (!meshed) out.mesh = RecordingReader(bag, settings).mesh();
  if (meshed) out.mesh = build_mesh(settings.mesh);
  BagReader reader(bag, settings);
  reader.set_mesh(out.mesh);
  reader.thin_images(1);
  while (std::optional<Instant> instant = loaded ? reader.next() : std::nullopt) {
    for (LoadSample& sample : instant->loads) out.loads.push_back(std::move(sample));
  }
  out.first_stamp = reader.first_stamp();
  return out;
}

// Returns the times of the measured loads and of those in files.
std::vector<double> load_times(const ModelSettings& settings, const Drive& drive) {
  std::vector<double> out;
  for (const LoadSample& sample : drive.loads) out.push_back(sample.time);
  for (const EffectSettings& effect : settings.effects) {
    if (!effect.arguments.has("course")) continue;
    const fs::path file = fs::path(settings.directory) / effect.arguments.at("course").at("file").as_text();
    for (const TableRow& row : read_table(file.string(), 1, "time [s]")) out.push_back(drive.first_stamp + row.numbers[0]);
  }
  return out;
}

Eigen::VectorXd read_theta(const Model& model, const SavedResults& results) {
  for (const FreeParameter& free : model.parameters().free()) {
    if (results.parameters.count(free.name) == 0)
      throw InputError(results.file + ": parameters", "no " + free.name, "the results of a run that used a frame");
  }
  return model.parameters().theta(model.parameters().coordinates(results.parameters, model.parameters().prior_mean()));
}

void read_map(EstimatedModel& out) {
  const std::string file = (fs::path(out.results.file).parent_path() / "map.vtk").string();
  const std::vector<int> patches = read_map_patches(file);
  if (static_cast<int>(patches.size()) != out.model->mesh().tet_count()) {
    throw InputError(file, std::to_string(patches.size()) + " tetrahedra",
                     std::to_string(out.model->mesh().tet_count()) + ", as the mesh has");
  }
  out.mapped_modulus.setConstant(out.model->mesh().tet_count(), std::numeric_limits<double>::quiet_NaN());
  const auto count = static_cast<int>(out.results.patches.size());
  for (std::size_t e = 0; e < patches.size(); ++e) {
    if (patches[e] >= count) {
      throw InputError(file, "patch " + std::to_string(patches[e]),
                       "below " + std::to_string(count) + ", as the results say");
    }
    if (patches[e] < 0) continue;
    out.mapped_modulus[static_cast<Eigen::Index>(e)] =
        out.results.patches[static_cast<std::size_t>(patches[e])].young_modulus;
  }
  const auto& free = out.model->parameters().free();
  const auto at = std::find_if(free.begin(), free.end(), [](const FreeParameter& p) { return is_young_modulus(p.name); });
  if (at == free.end()) throw InputError(out.results.file + ": map", "a map", "none, as no young_modulus is estimated");
  out.common_modulus = out.results.parameters.at(at->name);
}

std::vector<std::string> doubts(const SavedResults& results) {
  std::vector<std::string> out;
  if (!results.complete) out.emplace_back("the run was interrupted");
  if (results.state != to_string(EstimateState::converged))
    out.push_back("the estimate is " + results.state + (results.state_reason.empty() ? "" : ": " + results.state_reason));
  const auto unknown = std::count_if(results.patches.begin(), results.patches.end(),
                                     [](const SavedResults::Patch& patch) { return !patch.identified; });
  if (unknown > 0) {
    out.push_back("the map does not identify " + std::to_string(unknown) + " of its " +
                  std::to_string(results.patches.size()) + " parts");
  }
  if (results.map_misfit > StiffnessMap::kMostMisfit) out.emplace_back("the map does not explain the recording");
  return out;
}

}  // namespace

EstimatedModel load_estimated_model(const std::string& results, const ModelOption& given, const std::string& recording) {
  EstimatedModel out;
  out.results = read_results(results);
  const std::string file = existing(given.file, out.results.model, out.results.file, "model");
  const fs::path folder = fs::absolute(file).parent_path();
  const Value text = parse_yaml(out.results.model_text, file);
  if (!given.allow_outside) require_files_inside(text, folder.string(), ", or --allow-outside");
  const ModelSettings settings = read_model(text, folder.string());
  Drive drive = read_drive(settings, out.results, recording);
  if (drive.mesh.node_count() != out.results.nodes || drive.mesh.tet_count() != out.results.tetrahedra) {
    throw InputError(file + ": mesh", std::to_string(drive.mesh.node_count()) + " nodes",
                     std::to_string(out.results.nodes) + ", as when " + out.results.file + " was written");
  }
  out.model = std::make_unique<Model>(settings, drive.mesh);
  out.model->loads().drive(drive.first_stamp, drive.loads);
  out.theta = read_theta(*out.model, out.results);
  out.load_times = load_times(settings, drive);
  if (!out.results.patches.empty()) read_map(out);
  out.remarks = doubts(out.results);
  return out;
}

}  // namespace tissue_stiffness
