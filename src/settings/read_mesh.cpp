#include <limits>
#include <variant>

#include "settings/inside_folder.hpp"
#include "settings/key_spec.hpp"
#include "settings/read_sections.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double positive = std::numeric_limits<double>::min();

const KeySpec& key(const std::string& path) {
  return find_key(model_keys(), path);
}

Eigen::Vector3d read_direction(const Value& value) {
  const Eigen::Vector3d direction = value.as_vector3("");
  if (direction.norm() < positive) throw InputError(value.path(), value.shown(), "a direction, not zero");
  return direction.normalized();
}

void read_revolve(const Value& map, MeshSettings& mesh) {
  mesh.source = MeshSettings::Source::revolve;
  read_choice(map, key("mesh.revolve.contour"));
  mesh.axis = read_direction(map.at("axis"));
  mesh.max_edge_length = read_number(map, key("mesh.revolve.max_edge_length"));
}

void read_extrude(const Value& map, MeshSettings& mesh) {
  mesh.source = MeshSettings::Source::extrude;
  read_choice(map, key("mesh.extrude.contour"));
  mesh.depth = read_number(map, key("mesh.extrude.depth"));
  mesh.max_edge_length = read_number(map, key("mesh.extrude.max_edge_length"));
}

Eigen::Vector3d read_radii(const Value& value) {
  const Eigen::Vector3d radii = value.as_vector3("m");
  if (!(radii.array() > 0.0).all()) throw InputError(value.path(), value.shown(), "three numbers > 0 [m]");
  return radii;
}

BoxShape read_box(const Value& map) {
  const BoxShape box{map.at("min").as_vector3("m"), map.at("max").as_vector3("m")};
  if ((box.min.array() > box.max.array()).any()) {
    throw InputError(map.at("min").path(), map.at("min").shown(), "min <= max = " + map.at("max").shown());
  }
  return box;
}

VertexShape read_vertices(const Value& list) {
  VertexShape shape;
  for (const Value& item : list.items()) shape.vertices.push_back(item.as_integer(0, std::numeric_limits<int>::max()));
  if (shape.vertices.empty()) throw InputError(list.path(), "an empty list", "at least one vertex number");
  return shape;
}

RegionSettings read_region(const std::string& name, const Value& map) {
  const std::string allowed = "one of box, sphere, ellipsoid, half_space, vertices";
  if (map.type() != Value::Type::map || map.keys().size() != 1) throw InputError(map.path(), map.shown(), allowed);
  if (map.has("box")) return {name, read_box(map.at("box"))};
  if (map.has("sphere")) {
    const Value& sphere = map.at("sphere");
    return {name, SphereShape{sphere.at("center").as_vector3("m"), read_number(sphere, key("regions.*.sphere.radius"))}};
  }
  if (map.has("ellipsoid")) {
    const Value& ellipsoid = map.at("ellipsoid");
    return {name, EllipsoidShape{ellipsoid.at("center").as_vector3("m"), read_radii(ellipsoid.at("radii"))}};
  }
  if (map.has("half_space")) {
    const Value& half_space = map.at("half_space");
    return {name, HalfSpaceShape{half_space.at("point").as_vector3("m"), read_direction(half_space.at("normal"))}};
  }
  if (map.has("vertices")) return {name, read_vertices(map.at("vertices"))};
  throw InputError(map.path(), map.shown(), allowed);
}

}  // namespace

MeshSettings read_mesh(const Value& map, const std::string& directory) {
  MeshSettings mesh;
  const int sources = (map.has("file") ? 1 : 0) + (map.has("revolve") ? 1 : 0) + (map.has("extrude") ? 1 : 0);
  if (sources != 1) throw InputError(map.path(), map.shown(), "exactly one of file, revolve, extrude");
  if (map.has("revolve")) {
    read_revolve(map.at("revolve"), mesh);
  } else if (map.has("extrude")) {
    read_extrude(map.at("extrude"), mesh);
  } else {
    mesh.file = path_from(directory, map.at("file").as_text());
    mesh.scale = read_number(map, key("mesh.scale"));
    mesh.max_edge_length = read_number(map, key("mesh.max_edge_length"));
  }
  mesh.scale_tolerance = read_number(map, key("mesh.scale_tolerance"));
  mesh.surface_tolerance = read_number(map, key("mesh.surface_tolerance"));
  mesh.order = read_integer(map, key("mesh.order"));
  mesh.refine = read_integer(map, key("mesh.refine"));
  mesh.faceted = read_choice(map, key("mesh.boundary")) == "faceted";
  mesh.discretisation_error = read_boolean(map, key("mesh.discretisation_error"));
  return mesh;
}

std::vector<RegionSettings> read_regions(const Value& map) {
  if (map.type() != Value::Type::map) throw InputError(map.path(), map.shown(), "a map of named regions");
  std::vector<RegionSettings> regions;
  for (const std::string& name : map.keys()) {
    regions.push_back(read_region(name, map.at(name)));
  }
  return regions;
}

}  // namespace tissue_stiffness
