#include <algorithm>
#include <cmath>
#include <limits>

#include "settings/key_spec.hpp"
#include "settings/read_sections.hpp"
#include "settings/suggestion.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Kind = ObservationSettings::Kind;
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double kShareOfLargest = -0.1;               // a force sensor's bias that is not stated
constexpr int kLeastPixels = 32, kMostPixels = 16384;  // width and height of a part of an image

const KeySpec& key(const std::string& path) {
  return find_key(model_keys(), path);
}

Eigen::Matrix3Xd read_rest(const Value& list) {
  const std::vector<Value>& rows = list.items();
  if (rows.empty()) throw InputError(list.path(), "an empty list", "at least one rest position [x, y, z] [m]");
  Eigen::Matrix3Xd rest(3, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) rest.col(static_cast<Eigen::Index>(i)) = rows[i].as_vector3("m");
  return rest;
}

Eigen::Vector2d read_pixel(const Value& list) {
  const std::vector<Value>& items = list.items();
  if (items.size() != 2) throw InputError(list.path(), list.shown(), "two numbers [u, v] [pixel]");
  return {items[0].as_number(0.0, infinity, "pixel"), items[1].as_number(0.0, infinity, "pixel")};
}

PixelBox read_box(const Value& list) {
  const std::vector<Value>& items = list.items();
  if (items.size() != 4) throw InputError(list.path(), list.shown(), "four numbers [u, v, width, height] [pixel]");
  const auto whole = [&](std::size_t i, int least) { return items[i].as_integer(least, kMostPixels); };
  return {whole(0, 0), whole(1, 0), whole(2, kLeastPixels), whole(3, kLeastPixels)};
}

void read_images(const Value& map, ObservationSettings& observation) {
  const std::string path = std::string("observations[].") + traits_of(observation.kind).name;
  observation.topic = read_text(map, key(path + ".image"));
  observation.camera_info = read_text(map, key(path + ".camera_info"));
  if (map.has("rectified")) observation.rectified = read_boolean(map, key(path + ".rectified"));
}

void read_contour(const Value& map, ObservationSettings& observation) {
  if (map.has("segmentation")) observation.segmentation = read_segmentation(map.at("segmentation"));
  const bool slice = read_choice(map, key("observations[].contour.projection")) == "slice";
  observation.projection = slice ? ObservationSettings::Projection::slice : ObservationSettings::Projection::silhouette;
  observation.region = read_text(map, key("observations[].contour.region"));
}

FeatureSettings read_features(const Value& map) {
  const std::string path = "observations[].tracks.features.";
  FeatureSettings out;
  const bool tags = read_choice(map, key(path + "kind")) == "tags";
  out.kind = tags ? FeatureSettings::Kind::tags : FeatureSettings::Kind::texture;
  if (map.has("roi")) out.roi = read_box(map.at("roi"));
  if (tags) {
    const std::vector<std::string>& names = key(path + "dictionary").choices;
    const auto name = std::find(names.begin(), names.end(), read_choice(map, key(path + "dictionary")));
    out.dictionary = static_cast<int>(name - names.begin());
  } else {
    out.most = read_integer(map, key(path + "most"));
  }
  return out;
}

DepthCameraSettings read_depth_camera(const Value& map) {
  const std::string path = "observations[].points.depth_camera.";
  DepthCameraSettings out;
  out.margin = read_number(map, key(path + "margin"));
  out.voxel = read_number(map, key(path + "voxel"));
  out.neighbours = read_integer(map, key(path + "neighbours"));
  return out;
}

void read_reaction(const Value& map, ObservationSettings& observation) {
  observation.region = read_text(map, key("observations[].reaction.region"));
  observation.gain = read_number(map, key("observations[].reaction.gain"));
  const double bias = read_number(map, key("observations[].reaction.bias"));
  observation.bias = std::isnan(bias) ? kShareOfLargest : bias;
  observation.rate = read_number(map, key("observations[].reaction.rate"));
}

ObservationSettings read_observation(const Value& entry) {
  const std::vector<std::string> keys = entry.keys();
  std::vector<std::string> names;
  for (const Kind kind : kObservationKinds) names.emplace_back(traits_of(kind).name);
  if (keys.size() != 1) throw InputError(entry.path(), entry.shown(), "one observation an entry: " + join_words(names));
  ObservationSettings observation;
  bool known = false;
  for (const Kind kind : kObservationKinds) {
    if (traits_of(kind).name != keys.front()) continue;
    observation.kind = kind;
    known = true;
  }
  const Value& map = entry.at(keys.front());
  if (!known) throw InputError(map.path(), "`" + keys.front() + "`" + did_you_mean(keys.front(), names), join_words(names));
  if (traits_of(observation.kind).image) {
    read_images(map, observation);
  } else {
    observation.topic = read_text(map, key("observations[]." + keys.front() + ".topic"));
  }
  if (observation.kind == Kind::contour) read_contour(map, observation);
  if (observation.kind == Kind::tracks) {
    const Value none = Value::map({}, map.path());
    const Value& features = map.has("features") ? map.at("features") : none;
    observation.features = read_features(features);
  }
  if (observation.kind == Kind::markers) observation.rest = read_rest(map.at("rest"));
  if (observation.kind == Kind::points && map.has("depth_camera")) {
    observation.depth_camera = read_depth_camera(map.at("depth_camera"));
  }
  const std::string path = "observations[]." + keys.front();
  observation.noise = read_number(map, key(path + ".noise"));
  observation.rotation = read_number(map, key(path + ".rotation_tolerance"));
  if (observation.kind == Kind::reaction) {
    read_reaction(map, observation);
    return observation;
  }
  const double offset = read_number(map, key(path + ".offset_tolerance"));
  observation.offset = std::isnan(offset) ? observation.noise : offset;
  return observation;
}

void read_body(const Value& map, SegmentationSettings& segmentation) {
  using Body = SegmentationSettings::Body;
  const std::string segment = "observations[].contour.segmentation.";
  const std::string body = read_choice(map, key(segment + "body"));
  segmentation.body = body == "dark" ? Body::dark : body == "colour" ? Body::colour : Body::bright;
  if (segmentation.body != Body::colour) return;
  const Value& colour = map.at("colour");
  segmentation.colour = colour.as_vector3("");
  if (segmentation.colour.minCoeff() < 0.0 || segmentation.colour.maxCoeff() > 255.0) {
    throw InputError(colour.path(), colour.shown(), "[red, green, blue], each 0 to 255");
  }
  segmentation.tolerance = read_number(map, key(segment + "tolerance"));
}

}  // namespace

SegmentationSettings read_segmentation(const Value& map) {
  using SegmentationKind = SegmentationSettings::Kind;
  SegmentationSettings segmentation;
  const std::string kind = read_choice(map, key("observations[].contour.segmentation.kind"));
  segmentation.kind = kind == "cavity" ? SegmentationKind::cavity
                      : kind == "mask" ? SegmentationKind::mask
                                       : SegmentationKind::silhouette;
  if (map.has("seed")) segmentation.seed = read_pixel(map.at("seed"));
  if (map.has("roi")) segmentation.roi = read_box(map.at("roi"));
  if (segmentation.kind == SegmentationKind::silhouette) read_body(map, segmentation);
  return segmentation;
}

std::vector<ObservationSettings> read_observations(const Value& list) {
  std::vector<ObservationSettings> observations;
  for (const Value& entry : list.items()) observations.push_back(read_observation(entry));
  if (observations.empty()) throw InputError(list.path(), "an empty list", "at least one observation");
  return observations;
}

}  // namespace tissue_stiffness
