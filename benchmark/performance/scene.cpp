#include "scene.hpp"

#include <sstream>

#include "meshing/box_mesh.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMarkers = 500;
const Eigen::Vector3d kSize(0.10, 0.04, 0.04);  // [m]

Eigen::Vector3d centroid(const TetMesh& mesh, int facet) {
  const auto corners = mesh.facets.col(facet).head<3>();
  return (mesh.nodes.col(corners[0]) + mesh.nodes.col(corners[1]) + mesh.nodes.col(corners[2])) / 3.0;
}

// Spread over the facets; a coarse skin carries several markers a facet.
std::vector<int> choose_facets(const TetMesh& mesh) {
  std::vector<int> facets;
  for (int i = 0; i < kMarkers; ++i) {
    facets.push_back(static_cast<int>(static_cast<long>(i) * mesh.facet_count() / kMarkers));
  }
  return facets;
}

ModelSettings settings(const Scene& scene, double start) {
  std::ostringstream text;
  text.precision(17);
  text << "mesh: {file: block.vtk, discretisation_error: false}\n"
          "regions: {clamp: {box: {min: [-1, -1, -1], max: [1.0e-6, 1, 1]}}}\n"
          "effects:\n"
          "- inertia: {density: 1000}\n"
          "- elasticity: {law: "
       << (scene.law == Scene::Law::linear ? "linear" : "neo_hookean")
       << ", poisson_ratio: 0.45, young_modulus: {prior: " << start * kTruth
       << ", factor: 2}}\n"
          "- fixed: {region: clamp}\n"
          "- gravity: {acceleration: [0, 0, -9.81]}\n"
          "observations:\n"
          "- markers: {topic: /markers, noise: "
       << kMarkerNoise << ", rest: [";
  for (const int facet : scene.marked_facets) {
    const Eigen::Vector3d at = centroid(scene.mesh, facet);
    text << "[" << at.x() << ", " << at.y() << ", " << at.z() << "], ";
  }
  text << "]}\n";
  return read_model(parse_yaml(text.str(), "block"), "");
}

}  // namespace

Scene make_scene(Scene::Law law, int cells, int across, double start) {
  Scene scene{law, make_box_mesh(kSize, cells, across, across, 2), {}, {}};
  scene.marked_facets = choose_facets(scene.mesh);
  scene.settings = settings(scene, start);
  return scene;
}

Eigen::MatrixXd move(const Scene& scene, int count, double truth) {
  const Experiment experiment(scene.settings, scene.mesh, {truth});
  Eigen::MatrixXd motion(3 * scene.mesh.node_count(), count);
  const auto moments = experiment.film(0.0, kFrameInterval, count + 1);
  for (int k = 0; k < count; ++k) motion.col(k) = moments[static_cast<std::size_t>(k) + 1].displacement;
  return motion;
}

std::vector<Frame> film(const Scene& scene, int count, double truth, unsigned seed) {
  const Experiment experiment(scene.settings, scene.mesh, {truth});
  const auto sensors = make_observation_operators(experiment.model());
  std::mt19937 engine(seed);
  Observation blank;
  blank.kind = ObservationKind::markers;
  blank.ids = Eigen::VectorXi::LinSpaced(kMarkers, 0, kMarkers - 1);
  blank.points = Eigen::Matrix3Xd::Zero(3, kMarkers);
  std::vector<Frame> frames;
  for (const auto& moment : experiment.film(0.0, kFrameInterval, count + 1)) {
    if (moment.time == 0.0) continue;
    Observation seen = blank;
    seen.time = moment.time;
    const Eigen::VectorXd at = sensors.front()->predict(blank, moment.displacement).predicted;
    seen.points = Eigen::Map<const Eigen::Matrix3Xd>(at.data(), 3, kMarkers) + draw(kMarkers, kMarkerNoise, engine);
    frames.push_back({moment.time, {seen}});
  }
  return frames;
}

}  // namespace tissue_stiffness
