#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// `mesh: {file, scale, max_edge_length, order}` or `{revolve: ...}` or `{extrude: ...}`.
struct MeshSettings {
  enum class Source { file, revolve, extrude };
  Source source = Source::file;
  std::string file;                  ///< absolute, or relative to the model file's folder (resolved by the reader)
  double scale = 1.0;                ///< file unit -> m
  double scale_tolerance = 0.0;      ///< by which every length of the mesh may be off, 1 sigma [-]
  double max_edge_length = 0.0;      ///< [m]; 0: as the surface is
  int order = 2;                     ///< 2: 10-node tetrahedra, 1: 4-node
  bool faceted = false;              ///< the body has the mesh's facets; else they stand for a smooth surface
  bool discretisation_error = true;  ///< find out what the mesh does to the estimate, correct it, widen the interval
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< revolve: direction of the axis of revolution in `model`
  double depth = 0.0;                               ///< extrude: thickness along the viewing direction [m]
};

struct BoxShape {
  Eigen::Vector3d min, max;
};
struct SphereShape {
  Eigen::Vector3d center;
  double radius;
};
struct EllipsoidShape {
  Eigen::Vector3d center, radii;
};
struct HalfSpaceShape {
  Eigen::Vector3d point, normal;
};  ///< inside: (x - point) . normal <= 0
struct VertexShape {
  std::vector<int> vertices;
};

struct RegionSettings {
  std::string name;
  std::variant<BoxShape, SphereShape, EllipsoidShape, HalfSpaceShape, VertexShape> shape;
};

/// One entry of `effects`. Its keys are checked against the effect's spec by the effects layer.
struct EffectSettings {
  std::string name;   ///< effect, e.g. "elasticity"
  std::string label;  ///< name, or name#2 for the second entry of the same effect
  Value arguments;    ///< the map behind the name
};

struct SegmentationSettings {
  enum class Kind { silhouette, cavity };
  Kind kind = Kind::silhouette;
  std::optional<Eigen::Vector2d> seed;  ///< pixel inside the body or the cavity; found when absent
};

struct ObservationSettings {
  enum class Kind { vertices, markers, points, contour };
  enum class Projection { silhouette, slice };
  Kind kind = Kind::vertices;
  std::string topic;        ///< point cloud topic, or the image topic of a contour
  std::string camera_info;  ///< contour only
  double noise = 0.0;       ///< 1-sigma [m]
  double rotation = 0.0;    ///< tolerance of the sensor's pose, 1 sigma about each axis [rad]
  double offset = 0.0;      ///< the same along each axis [m]
  Eigen::Matrix3Xd rest;    ///< markers: rest positions [m]
  SegmentationSettings segmentation;
  Projection projection = Projection::silhouette;
  std::string region;  ///< contour: part of the surface the outline belongs to; empty: all
};

struct TimeSettings {
  double start = 0.0;  ///< when the body was at rest, undeformed, after the recording's first stamp [s]
  double step = 0.0;   ///< integration step [s]; 0: chosen
};

struct InitialSettings {
  enum class Kind { rest, velocity, from_frames };
  Kind kind = Kind::rest;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< rigid initial velocity [m/s]
};

/// `map: {cells, length, factor}`: how the modulus may vary over the body.
struct MapSettings {
  int cells = 0;        ///< patches at the finest level
  double length = 0.0;  ///< over which log E stays alike [m]
  double factor = 0.0;  ///< 1 sigma by which the modulus varies, > 1
};

enum class EstimatorKind { unscented, paper };

/// A whole model file.
struct ModelSettings {
  std::string name;       ///< file or parameter namespace, for messages
  std::string directory;  ///< relative files are looked up here
  MeshSettings mesh;
  std::vector<RegionSettings> regions;
  std::vector<EffectSettings> effects;
  std::vector<ObservationSettings> observations;
  TimeSettings time;
  InitialSettings initial;
  bool exact_inputs = false;  ///< every load, pose and constant is taken as exact, whatever its tolerance
  double stale_after = 2.0;   ///< without a measurement or a load for so long the estimate is stale [s]
  int window = 4000;  ///< frames kept to be looked at again; half of them become the prior of the others when it is full
  EstimatorKind estimator = EstimatorKind::unscented;  ///< key `estimator: unscented | paper`
  std::optional<MapSettings> map;                      ///< empty: one modulus an elasticity, no map
};

/// Reads every key but the effects' arguments, which the effects layer checks. Unknown, missing and out-of-range keys throw
/// InputError.
ModelSettings read_model(const Value& root, const std::string& directory);

/// Appends an effect and labels it; what label it had does not matter.
void add_effect(ModelSettings& model, EffectSettings effect);

/// Appends one entry of `effects`, as YAML: "viscous_damping: {beta: 0.01}". Throws InputError for what is no such entry.
void add_effect(ModelSettings& model, const std::string& entry);

/// Removes the last effect of that name. Throws InputError when there is none.
void remove_effect(ModelSettings& model, const std::string& name);

/// read_model of a YAML file; relative paths count from the file's folder.
ModelSettings load_model(const std::string& file);

}  // namespace tissue_stiffness
