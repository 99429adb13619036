#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <cstring>
#include <string>
#include <vector>

/// A cloud of x y z [m] and one integer field, as trackers send it.
inline sensor_msgs::PointCloud2 make_cloud(const std::vector<std::vector<float>>& points, const std::string& id_name,
                                           const std::vector<std::int32_t>& ids) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header.frame_id = "model";
  cloud.header.stamp = ros::Time(10, 500000000);
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(points.size());
  cloud.point_step = 16;
  cloud.row_step = 16 * cloud.width;
  cloud.is_dense = 1;
  const std::vector<std::string> names{"x", "y", "z", id_name};
  for (std::uint32_t i = 0; i < 4; ++i) {
    sensor_msgs::PointField field;
    field.name = names[i];
    field.offset = 4 * i;
    field.count = 1;
    field.datatype = i < 3 ? sensor_msgs::PointField::FLOAT32 : sensor_msgs::PointField::INT32;
    cloud.fields.push_back(field);
  }
  cloud.data.resize(cloud.row_step);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(&cloud.data[16 * i], points[i].data(), 12);
    std::memcpy(&cloud.data[16 * i + 12], &ids[i], 4);
  }
  return cloud;
}
