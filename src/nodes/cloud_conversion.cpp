#include <cmath>
#include <cstring>

#include "nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Cloud = sensor_msgs::PointCloud2;
using Field = sensor_msgs::PointField;

std::size_t width_of(std::uint8_t datatype) {
  switch (datatype) {
    case Field::INT8:
    case Field::UINT8:
      return 1;
    case Field::INT16:
    case Field::UINT16:
      return 2;
    case Field::INT32:
    case Field::UINT32:
    case Field::FLOAT32:
      return 4;
    case Field::FLOAT64:
      return 8;
    default:
      return 0;
  }
}

std::string field_names(const Cloud& cloud) {
  std::string names;
  for (const Field& field : cloud.fields) names += (names.empty() ? "" : ", ") + field.name;
  return names.empty() ? "none" : names;
}

const Field& find_field(const Cloud& cloud, const std::string& name, bool integer, const std::string& topic) {
  for (const Field& field : cloud.fields) {
    if (field.name != name) continue;
    const bool real = field.datatype == Field::FLOAT32 || field.datatype == Field::FLOAT64;
    const std::size_t width = width_of(field.datatype);
    if (width == 0 || real == integer) {
      throw InputError(topic + ": field " + name, "datatype " + std::to_string(field.datatype),
                       integer ? "an integer (1 to 6)" : "FLOAT32 (7) or FLOAT64 (8)");
    }
    if (field.count != 1) throw InputError(topic + ": field " + name, "count " + std::to_string(field.count), "1");
    if (field.offset + width > cloud.point_step) {
      throw InputError(topic + ": field " + name, "offset " + std::to_string(field.offset),
                       "a field inside point_step " + std::to_string(cloud.point_step));
    }
    return field;
  }
  throw InputError(topic, "fields " + field_names(cloud), "a field " + name);
}

void check_layout(const Cloud& cloud, const std::string& topic) {
  if (cloud.is_bigendian) throw InputError(topic, "is_bigendian true", "little endian");
  const std::uint64_t row = std::uint64_t{cloud.width} * cloud.point_step;
  if (cloud.row_step < row) {
    throw InputError(topic, "row_step " + std::to_string(cloud.row_step),
                     "at least width * point_step = " + std::to_string(row));
  }
  const std::uint64_t size = std::uint64_t{cloud.height} * cloud.row_step;
  if (cloud.data.size() != size) {
    throw InputError(topic, std::to_string(cloud.data.size()) + " bytes of data",
                     "height * row_step = " + std::to_string(size));
  }
}

template <typename T>
double load(const std::uint8_t* data) {
  T value;
  std::memcpy(&value, data, sizeof(T));
  return static_cast<double>(value);
}

double read(const std::uint8_t* point, const Field& field) {
  const std::uint8_t* data = point + field.offset;
  switch (field.datatype) {
    case Field::INT8:
      return load<std::int8_t>(data);
    case Field::UINT8:
      return load<std::uint8_t>(data);
    case Field::INT16:
      return load<std::int16_t>(data);
    case Field::UINT16:
      return load<std::uint16_t>(data);
    case Field::INT32:
      return load<std::int32_t>(data);
    case Field::UINT32:
      return load<std::uint32_t>(data);
    case Field::FLOAT32:
      return load<float>(data);
    default:
      return load<double>(data);
  }
}

/// The fields from which a cloud is read.
class Columns {
 public:
  Columns(const Cloud& cloud, const std::string& id_name, int id_count, const std::string& topic)
      : topic_(topic), id_name_(id_name), id_count_(id_count) {
    for (const char* axis : {"x", "y", "z"}) axes_.push_back(&find_field(cloud, axis, false, topic));
    if (!id_name.empty()) id_ = &find_field(cloud, id_name, true, topic);
  }

  Eigen::Vector3d position(const std::uint8_t* point) const {
    return {read(point, *axes_[0]), read(point, *axes_[1]), read(point, *axes_[2])};
  }

  int id(const std::uint8_t* point) const {
    const double value = read(point, *id_);
    if (value < 0 || value >= id_count_) {
      throw InputError(topic_ + ": field " + id_name_, std::to_string(static_cast<long long>(value)),
                       "0 to " + std::to_string(id_count_ - 1));
    }
    return static_cast<int>(value);
  }
  bool has_id() const { return id_ != nullptr; }

 private:
  const std::string& topic_;
  std::string id_name_;
  int id_count_;
  std::vector<const Field*> axes_;
  const Field* id_ = nullptr;
};

}  // namespace

Observation to_observation(const Cloud& cloud, const ObservationSettings& settings, int source, int vertex_count,
                           const Eigen::Isometry3d& model_from_sensor) {
  const std::string& topic = settings.topic;
  check_layout(cloud, topic);
  const bool vertices = settings.kind == ObservationSettings::Kind::vertices;
  const bool markers = settings.kind == ObservationSettings::Kind::markers;
  const Columns columns(cloud,
                        vertices  ? "vertex"
                        : markers ? "marker"
                                  : "",
                        vertices ? vertex_count : static_cast<int>(settings.rest.cols()), topic);
  Observation out;
  out.source = source;
  out.kind = settings.kind;
  out.time = cloud.header.stamp.toSec();
  const Eigen::Index most = Eigen::Index{cloud.width} * cloud.height;
  out.points.resize(3, most);
  if (columns.has_id()) out.ids.resize(most);
  Eigen::Index kept = 0;
  for (std::uint32_t i = 0; i < cloud.width * cloud.height; ++i) {
    const std::uint8_t* point =
        cloud.data.data() + std::size_t{i / cloud.width} * cloud.row_step + std::size_t{i % cloud.width} * cloud.point_step;
    const Eigen::Vector3d position = columns.position(point);
    if (!position.allFinite()) {
      if (!cloud.is_dense || settings.depth_camera) continue;
      throw InputError(topic + ": point " + std::to_string(i), "a coordinate that is not finite",
                       "finite coordinates, or is_dense false");
    }
    if (columns.has_id()) out.ids[kept] = columns.id(point);
    out.points.col(kept++) = model_from_sensor * position;
  }
  out.points.conservativeResize(3, kept);
  if (columns.has_id()) out.ids.conservativeResize(kept);
  return out;
}

}  // namespace tissue_stiffness
