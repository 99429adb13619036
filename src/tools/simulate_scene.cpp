#include "tools/simulate_scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <random>
#include <set>
#include <sstream>

#include "forward/full_model.hpp"
#include "meshing/refine.hpp"
#include "observation/closest_point.hpp"
#include "observation/observation_operator.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/recording_writer.hpp"
#include "tools/render.hpp"

namespace tissue_stiffness {
namespace {

using Kind = ObservationSettings::Kind;

const ros::Time kFirstStamp(1700000000, 0);
constexpr double kMostFrames = 1e5, kMostSteps = 1e7;

double frames_of(const Scene& scene) {
  return std::floor(scene.duration * scene.rate + 1e-9);
}

TetMesh refined_mesh(const Scene& scene) {
  if (scene.model.mesh.source != MeshSettings::Source::file) {
    throw InputError(scene.model.name + ": mesh", "a mesh from a contour", "file");
  }
  TetMesh mesh = build_mesh(scene.model.mesh);
  for (int i = 0; i < scene.refine; ++i) mesh = refine_mesh(mesh);
  return mesh;
}

/// Returns the vertices of the unrefined mesh that a sensor follows. Refinement keeps their numbers.
Eigen::VectorXi followed_vertices(const Scene& scene, const SensorScene& sensor) {
  std::vector<int> ids = sensor.vertices;
  if (ids.empty()) {
    const TetMesh mesh = build_mesh(scene.model.mesh);
    std::set<int> surface;
    for (Eigen::Index f = 0; f < mesh.facets.cols(); ++f) {
      for (int i = 0; i < 3; ++i) surface.insert(mesh.facets(i, f));
    }
    int k = 0;
    for (const int vertex : surface) {
      if (k++ % sensor.every == 0) ids.push_back(vertex);
    }
  }
  return Eigen::Map<Eigen::VectorXi>(ids.data(), static_cast<Eigen::Index>(ids.size()));
}

/// Returns the displacement with every surface node moved outward by the surface sensors' offset.
Eigen::VectorXd swollen(const ObservedMotion& motion) {
  Eigen::VectorXd u = motion.displacement;
  if (motion.outward == 0.0) return u;
  const SurfaceTriangles triangles = split_facets(motion.mesh);
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, motion.mesh.node_count());
  const auto place = [&](int node) -> Eigen::Vector3d { return motion.mesh.nodes.col(node) + u.segment<3>(3 * node); };
  for (Eigen::Index t = 0; t < triangles.nodes.cols(); ++t) {
    const Eigen::Vector3i n = triangles.nodes.col(t);
    const Eigen::Vector3d area = (place(n[1]) - place(n[0])).cross(place(n[2]) - place(n[0]));
    for (const int node : {n[0], n[1], n[2]}) normals.col(node) += area;
  }
  for (Eigen::Index i = 0; i < normals.cols(); ++i) {
    if (!normals.col(i).isZero(0.0)) u.segment<3>(3 * i) += motion.outward * normals.col(i).normalized();
  }
  return u;
}

/// One sensor of the scene.
class Sensor {
 public:
  Sensor(const Scene& scene, const Model& model, std::size_t number)
      : model_(model),
        observation_(scene.model.observations[number]),
        scene_(scene.sensors[number]),
        frame_("sensor_" + std::to_string(number)),
        random_(scene.seed + 7919 * (number + 1)) {
    if (scene_.image) {
      const bool slice = observation_.projection == ObservationSettings::Projection::slice;
      renderer_ = slice ? make_echo_renderer(model, observation_, *scene_.image, random_())
                        : make_camera_renderer(model, *scene_.image, random_());
    } else if (observation_.kind == Kind::vertices) {
      ids_ = followed_vertices(scene, scene_);
      operator_ = make_vertex_operator(model, observation_);
    } else if (observation_.kind == Kind::markers) {
      ids_ = Eigen::VectorXi::LinSpaced(observation_.rest.cols(), 0, static_cast<int>(observation_.rest.cols()) - 1);
      operator_ = make_marker_operator(model, observation_);
    } else if (observation_.kind == Kind::reaction) {
      operator_ = make_reaction_operator(model, observation_);
    }
    if (operator_) operator_->check(seen());
  }

  void start(RecordingWriter& writer) const {
    if (scene_.image) writer.write_pose(frame_, kFirstStamp, scene_.image->camera.model_from_sensor);
  }

  /// `output` is that of the run, whose motion the sensors see as `motion`.
  void record(const Eigen::VectorXd& output, const ObservedMotion& motion, int frame, const ros::Time& stamp,
              RecordingWriter& writer) {
    if (traits_of(observation_.kind).force) return record_force(output, stamp, writer);
    const bool named = observation_.kind == Kind::vertices || observation_.kind == Kind::markers;
    const Eigen::VectorXd u = named ? motion.displacement : swollen(motion);
    if (scene_.image) {
      const Eigen::Matrix3Xd x = model_.mesh().nodes + Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3);
      writer.write_image(observation_.topic, observation_.camera_info, frame_, stamp, scene_.image->camera,
                         renderer_->draw(x, frame));
      return;
    }
    Eigen::Matrix3Xd points = operator_ ? tracked(u) : sampled(u);
    points += noise(points.cols());
    const std::string id = observation_.kind == Kind::vertices  ? "vertex"
                           : observation_.kind == Kind::markers ? "marker"
                                                                : "";
    writer.write_cloud(observation_.topic, stamp, points, ids_, id);
  }

 private:
  void record_force(const Eigen::VectorXd& output, const ros::Time& stamp, RecordingWriter& writer) {
    Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
    wrench.head<3>() = operator_->predict(seen(), output).predicted + noise(1).col(0);
    writer.write_load({observation_.topic, LoadInput::Kind::wrench}, stamp, wrench);
  }

  /// Returns the noise of this frame. In time it is an autoregression with coefficient `memory` and a constant variance.
  Eigen::Matrix3Xd noise(Eigen::Index count) {
    Eigen::Matrix3Xd fresh(3, count);
    for (Eigen::Index i = 0; i < fresh.size(); ++i) fresh.data()[i] = scene_.noise * normal_(random_);
    const bool first = noise_.size() == 0;
    if (scene_.memory > 0.0 && !first) {
      fresh = scene_.memory * noise_ + std::sqrt(1.0 - scene_.memory * scene_.memory) * fresh;
    }
    noise_ = fresh;
    return fresh;
  }

  Observation seen() const {
    Observation observation;
    observation.kind = observation_.kind;
    observation.points = Eigen::Matrix3Xd::Zero(3, traits_of(observation_.kind).force ? 1 : ids_.size());
    observation.ids = ids_;
    return observation;
  }

  Eigen::Matrix3Xd tracked(const Eigen::VectorXd& u) const {
    const Prediction prediction = operator_->predict(seen(), u);
    return Eigen::Map<const Eigen::Matrix3Xd>(prediction.predicted.data(), 3, ids_.size());
  }

  /// Returns points that are spread evenly over the surface.
  Eigen::Matrix3Xd sampled(const Eigen::VectorXd& u) {
    const Eigen::Matrix3Xd x = model_.mesh().nodes + Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3);
    const SurfaceTriangles triangles = split_facets(model_.mesh());
    std::vector<double> area;
    for (Eigen::Index t = 0; t < triangles.nodes.cols(); ++t) {
      const Eigen::Vector3i n = triangles.nodes.col(t);
      area.push_back((x.col(n[1]) - x.col(n[0])).cross(x.col(n[2]) - x.col(n[0])).norm());
    }
    std::discrete_distribution<int> pick(area.begin(), area.end());
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Eigen::Matrix3Xd points(3, scene_.points);
    for (int i = 0; i < scene_.points; ++i) {
      const Eigen::Vector3i n = triangles.nodes.col(pick(random_));
      double r = unit(random_), s = unit(random_);
      if (r + s > 1.0) r = 1.0 - r, s = 1.0 - s;
      points.col(i) = (1.0 - r - s) * x.col(n[0]) + r * x.col(n[1]) + s * x.col(n[2]);
    }
    return points;
  }

  const Model& model_;
  ObservationSettings observation_;
  SensorScene scene_;
  std::string frame_;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  Eigen::VectorXi ids_;
  Eigen::Matrix3Xd noise_;  ///< of the last frame
  std::unique_ptr<ObservationOperator> operator_;
  std::unique_ptr<Renderer> renderer_;
};

void require_known(const Scene& scene, const Model& model) {
  if (model.parameters().free().empty()) return;
  throw InputError(scene.model.name + ": " + model.parameters().free().front().name, "an estimated number",
                   "known numbers only: a scene is the truth");
}

/// The exact loads act, while the published ones may be noisy.
void drive(const Scene& scene, Model& model) {
  model.loads().set_first_stamp(kFirstStamp.toSec());
  for (const LoadScene& load : scene.loads) {
    model.loads().courses().at(load.input.topic)->set_smoothing(0.0);
    const auto count = static_cast<int>(std::ceil(scene.duration / scene.step)) + 1;
    for (int k = 0; k <= count; ++k) {
      const double time = k * scene.step;
      model.loads().courses().at(load.input.topic)->add(kFirstStamp.toSec() + time, load.value(time));
    }
  }
}

/// The measured values of one load.
class LoadMessages {
 public:
  LoadMessages(const Scene& scene, std::size_t index)
      : load_(scene.loads[index]),
        count_(static_cast<int>(std::ceil(scene.duration * load_.rate)) + 1),
        random_(scene.seed + 104729 * (index + 1)) {}

  /// Writes those up to this time [s], so that a bag holds all topics in the order of time, which is quick to read.
  void write_until(double time, RecordingWriter& writer) {
    for (; next_ < count_ && next_ / load_.rate <= time; ++next_) {
      Eigen::VectorXd value = load_.value(next_ / load_.rate);  // of a pose, the position comes first
      for (Eigen::Index c = 0; c < std::min<Eigen::Index>(value.size(), 3); ++c) value[c] += load_.noise * normal_(random_);
      writer.write_load(load_.input, kFirstStamp + ros::Duration(next_ / load_.rate), value);
    }
  }

 private:
  const LoadScene& load_;
  int count_, next_ = 0;
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

}  // namespace

void require_moderate(const Scene& scene) {
  const double frames = frames_of(scene), steps = scene.duration / scene.step;
  if (frames <= kMostFrames && steps <= kMostSteps) return;
  std::ostringstream found, most;
  found << frames << " frames (duration x rate) and " << steps << " time steps (duration / step)";
  most << kMostFrames << " and " << kMostSteps << ", or --force";
  throw InputError(scene.model.name + ": simulation", found.str(), most.str());
}

SimulationSummary simulate_scene(const Scene& scene, const std::string& recording,
                                 const std::function<void(std::size_t, std::size_t)>& progress) {
  const TetMesh mesh = refined_mesh(scene);
  Model model(scene.model, mesh, resolve_regions(scene.model.regions, mesh, scene.model.mesh.refine + scene.refine));
  require_known(scene, model);
  drive(scene, model);
  FullModel::Options options;
  options.step = scene.step;
  options.spectral_radius = scene.spectral_radius;
  std::vector<std::unique_ptr<Sensor>> sensors;
  for (std::size_t i = 0; i < scene.sensors.size(); ++i) sensors.push_back(std::make_unique<Sensor>(scene, model, i));
  RecordingWriter writer(recording);
  for (const auto& sensor : sensors) sensor->start(writer);
  std::vector<LoadMessages> loads;
  for (std::size_t i = 0; i < scene.loads.size(); ++i) loads.emplace_back(scene, i);
  const auto write_loads = [&](double time) {
    for (LoadMessages& load : loads) load.write_until(time, writer);
  };
  const FullModel forward(model, options);
  const Eigen::VectorXd theta = model.parameters().theta(Eigen::VectorXd(0));
  const double start = kFirstStamp.toSec() + scene.model.time.start;
  const auto trajectory = forward.start(theta, start);
  SimulationSummary summary;
  summary.nodes = model.mesh().node_count();
  const auto total = static_cast<int>(std::min<double>(frames_of(scene), std::numeric_limits<int>::max()));
  double square = 0.0;
  for (int k = 0; k < total; ++k) {
    const ros::Time stamp = kFirstStamp + ros::Duration(k / scene.rate);
    write_loads(k / scene.rate);
    trajectory->advance(stamp.toSec() - model.sensors().delay(theta));
    const Eigen::VectorXd output = trajectory->output(), u = output.head(model.fem().dof_count());
    const ObservedMotion seen = model.sensors().observe(theta, stamp.toSec() - start, u);
    for (const auto& sensor : sensors) sensor->record(output, seen, k, stamp, writer);
    square += u.squaredNorm() / summary.nodes;
    const Eigen::Map<const Eigen::Matrix3Xd> moved(u.data(), 3, u.size() / 3);
    summary.motion_max = std::max(summary.motion_max, moved.colwise().norm().maxCoeff());
    summary.frames = k + 1;
    progress(static_cast<std::size_t>(k) + 1, static_cast<std::size_t>(total));
  }
  write_loads(std::numeric_limits<double>::infinity());
  writer.close();
  summary.motion_rms = std::sqrt(square / std::max(1, total));
  return summary;
}

}  // namespace tissue_stiffness
