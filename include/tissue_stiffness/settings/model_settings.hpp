#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "tissue_stiffness/settings/value.hpp"
#include "tissue_stiffness/types/observation.hpp"

namespace tissue_stiffness {

/// Settings under `mesh: {file, scale, max_edge_length, order}`, `{revolve: ...}` or `{extrude: ...}`.
struct MeshSettings {
  enum class Source { file, revolve, extrude };
  Source source = Source::file;
  std::string file;                  ///< absolute, or relative to the model file's folder (the reader resolves it)
  double scale = 1.0;                ///< metres per unit of the file
  double scale_tolerance = 0.0;      ///< relative error of every length of the mesh, 1 sigma [-]
  double surface_tolerance = 0.0;    ///< by which the whole surface may lie too far out or in, 1 sigma [m]
  double max_edge_length = 0.0;      ///< [m]; 0: the surface keeps its edges
  int order = 2;                     ///< 2: 10-node tetrahedra, 1: 4-node
  int refine = 0;                    ///< number of times that every tetrahedron is cut into eight
  bool faceted = false;              ///< true: the body has the mesh's facets; false: they stand for a smooth surface
  bool discretisation_error = true;  ///< estimate the mesh's effect on the estimate, correct it and widen the interval
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< revolve: direction of the axis of revolution in `model`
  double depth = 0.0;                               ///< extrude: thickness along the viewing direction [m]
};

/// Between two corners [m].
struct BoxShape {
  Eigen::Vector3d min, max;
};
/// Around a centre [m].
struct SphereShape {
  Eigen::Vector3d center;
  double radius;
};
/// Around a centre, with half axes along x, y and z [m].
struct EllipsoidShape {
  Eigen::Vector3d center, radii;
};
/// On one side of a plane through `point` [m]: (x - point) . normal <= 0.
struct HalfSpaceShape {
  Eigen::Vector3d point, normal;
};
/// Vertices by their numbers in the mesh.
struct VertexShape {
  std::vector<int> vertices;
};

/// A named part of the mesh at rest.
struct RegionSettings {
  std::string name;
  std::variant<BoxShape, SphereShape, EllipsoidShape, HalfSpaceShape, VertexShape> shape;
};

/// One entry of the list `effects`. The effects layer checks its keys against the effect's spec.
struct EffectSettings {
  std::string name;   ///< name of the effect, e.g. "elasticity"
  std::string label;  ///< name, or name#2 for the second entry of the same effect
  Value arguments;    ///< the map that follows the name
};

/// A part of an image [pixel].
struct PixelBox {
  int u = 0, v = 0;  ///< its upper left pixel
  int width = 0, height = 0;
};

/// How the outline of the tissue is found in images.
struct SegmentationSettings {
  enum class Kind { silhouette, cavity, mask };
  enum class Body { bright, dark, colour };
  Kind kind = Kind::silhouette;
  std::optional<Eigen::Vector2d> seed{};  ///< pixel inside the body or the cavity; found automatically when absent
  std::optional<PixelBox> roi{};          ///< part of the image that the body lies in; all when absent
  // The following members are for a silhouette only.
  Body body = Body::bright;                          ///< by what it differs from its background
  Eigen::Vector3d colour = Eigen::Vector3d::Zero();  ///< red, green and blue of the body, 0 to 255
  double tolerance = 0.0;                            ///< distance in the plane a*, b* of CIE Lab that is still this colour
};

/// How features of the body's surface are found and followed in images.
struct FeatureSettings {
  enum class Kind { texture, tags };
  Kind kind = Kind::texture;
  std::optional<PixelBox> roi{};  ///< part of the reference image that they are looked for in; all when absent
  int most = 0;                   ///< only for texture: number of features
  int dictionary = 0;             ///< only for tags: number of OpenCV's predefined dictionary
};

/// What is done with the clouds of a depth camera, which also sees what is not the body.
struct DepthCameraSettings {
  double margin = 0.0;  ///< around the mesh at rest; points farther away are left out [m]
  double voxel = 0.0;   ///< edge of cubes whose number is that of the points kept [m]; 0: 1/25 of the body's size
  int neighbours = 0;   ///< a point with fewer others around it is left out
};

/// One entry of the list `observations`: a sensor and its errors.
struct ObservationSettings {
  using Kind = ObservationKind;
  enum class Projection { silhouette, slice };
  Kind kind = Kind::vertices;
  std::string topic;        ///< topic of the point cloud, or of the images for a contour and for tracks
  std::string camera_info;  ///< topic of the calibration; only for a contour and for tracks
  double noise = 0.0;       ///< 1 sigma [m]; of a reaction [N]
  double rotation = 0.0;    ///< tolerance of the sensor's orientation, 1 sigma about each axis [rad]
  double offset = 0.0;      ///< tolerance of the sensor's position, 1 sigma along each axis [m]
  Eigen::Matrix3Xd rest;    ///< only for markers: their positions at rest [m]
  std::optional<DepthCameraSettings> depth_camera;  ///< only for points
  SegmentationSettings segmentation;                ///< only for a contour
  FeatureSettings features;                         ///< only for tracks
  Projection projection = Projection::silhouette;
  std::optional<bool>
      rectified;       ///< only for a contour and for tracks: the images have no distortion any more; absent: not stated
  std::string region;  ///< contour: part of the surface it belongs to, empty: all; reaction: the region that is pushed
  double gain = 0.0;   ///< only for a reaction: relative error of the force's scale, 1 sigma
  double bias = 0.0;   ///< the same: constant offset of each component, 1 sigma [N]; negative: a share of the largest force
  double rate = 0.0;   ///< the same: most measurements a second [Hz]
};

/// Settings under `time`.
struct TimeSettings {
  double start = 0.0;  ///< when the body was at rest and undeformed, after the recording's first stamp [s]
  double step = 0.0;   ///< integration step [s]; 0: chosen automatically
};

/// How the body moves when the recording begins.
struct InitialSettings {
  enum class Kind { rest, velocity, from_frames };
  Kind kind = Kind::rest;
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< rigid initial velocity [m/s]
};

/// Settings under `map: {cells, length, factor}`: how the modulus may vary over the body.
struct MapSettings {
  int cells = 0;        ///< number of patches at the finest level
  double length = 0.0;  ///< correlation length of log E [m]
  double factor = 0.0;  ///< 1-sigma factor by which the modulus varies, > 1
};

/// Settings of a complete model file.
struct ModelSettings {
  std::string name;       ///< file or parameter namespace, used in messages
  std::string directory;  ///< folder from which relative paths are resolved
  MeshSettings mesh;
  std::vector<RegionSettings> regions;
  std::vector<EffectSettings> effects;
  std::vector<ObservationSettings> observations;
  TimeSettings time;
  InitialSettings initial;
  bool exact_inputs = false;  ///< take every load, pose and constant as exact, whatever its tolerance
  double stale_after = 2.0;   ///< time without a measurement or a load after which the estimate is stale [s]
  int window = 4000;  ///< frames kept for reprocessing; when it is full, the older half becomes the prior of the others
  std::string estimator = "unscented";  ///< name of the scheme that turns frames into an estimate
  /// Parameters whose prior is an earlier estimate of the same body. No key: a node that resumes fills it.
  std::vector<std::string> known_before;
  std::optional<MapSettings> map;  ///< empty: each elasticity has one modulus, and no map is made
};

/// Reads all keys except the effects' arguments, which the effects layer checks. Throws InputError for a key that is
/// unknown, missing or out of range.
ModelSettings read_model(const Value& root, const std::string& directory);

/// Appends an effect and gives it a label, whatever label it had.
void add_effect(ModelSettings& model, EffectSettings effect);

/// Appends one entry of the list `effects`, given as YAML: "viscous_damping: {beta: 0.01}". Throws InputError if the text
/// is not such an entry.
void add_effect(ModelSettings& model, const std::string& entry);

/// Removes the last effect with this name. Throws InputError when there is none.
void remove_effect(ModelSettings& model, const std::string& name);

/// Calls read_model for a YAML file. Relative paths count from the file's folder.
ModelSettings load_model(const std::string& file);

}  // namespace tissue_stiffness
