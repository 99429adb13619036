// A PointCloud2 whose sizes, fields and data are arbitrary, as each kind of observation. ROS has deserialised it before.
#include <fuzzer/FuzzedDataProvider.h>

#include "fuzz_input.hpp"
#include "nodes/sensor_conversions.hpp"

namespace {

sensor_msgs::PointCloud2 any_cloud(FuzzedDataProvider& bytes) {
  static const char* const names[] = {"x", "y", "z", "vertex", "marker", "intensity", ""};
  sensor_msgs::PointCloud2 cloud;
  const int fields = bytes.ConsumeIntegralInRange(0, 6);
  for (int i = 0; i < fields; ++i) {
    sensor_msgs::PointField field;
    field.name = bytes.PickValueInArray(names);
    field.offset = bytes.ConsumeBool() ? bytes.ConsumeIntegral<std::uint32_t>() : bytes.ConsumeIntegralInRange(0U, 32U);
    field.datatype = bytes.ConsumeIntegralInRange<std::uint8_t>(0, 9);
    field.count = bytes.ConsumeBool() ? bytes.ConsumeIntegral<std::uint32_t>() : 1;
    cloud.fields.push_back(field);
  }
  const auto size = [&] {
    return bytes.ConsumeBool() ? bytes.ConsumeIntegral<std::uint32_t>() : bytes.ConsumeIntegralInRange(0U, 64U);
  };
  cloud.width = size();
  cloud.height = size();
  cloud.point_step = size();
  cloud.row_step = size();
  cloud.is_bigendian = bytes.ConsumeBool();
  cloud.is_dense = bytes.ConsumeBool();
  cloud.data = bytes.ConsumeRemainingBytes<std::uint8_t>();
  return cloud;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tissue_stiffness;
  FuzzedDataProvider bytes(data, size);
  const sensor_msgs::PointCloud2 cloud = any_cloud(bytes);
  for (const ObservationKind kind : {ObservationKind::vertices, ObservationKind::markers, ObservationKind::points}) {
    ObservationSettings settings;
    settings.kind = kind;
    settings.topic = "/cloud";
    fuzz_text(data, size,
              [&](const std::string&) { to_observation(cloud, settings, 0, 100, Eigen::Isometry3d::Identity()); });
  }
  return 0;
}
