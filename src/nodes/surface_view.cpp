#include "nodes/surface_view.hpp"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

namespace tissue_stiffness {
namespace {

constexpr int kRings = 3;  // of facets around a measured node, over which its misfit is interpolated
constexpr double kAmbient = 0.65;

/// The scale of the report's surface, from blue over cream to red, which colour-blind people tell apart.
const std::array<Eigen::Vector3f, 5> kScale = {
    Eigen::Vector3f(0.231F, 0.435F, 0.714F), Eigen::Vector3f(0.435F, 0.718F, 0.788F),
    Eigen::Vector3f(0.957F, 0.910F, 0.643F), Eigen::Vector3f(0.941F, 0.565F, 0.290F),
    Eigen::Vector3f(0.710F, 0.090F, 0.184F)};

/// `share`: of the limit.
Eigen::Vector3f heat_colour(double share) {
  if (!std::isfinite(share)) return Eigen::Vector3f::Constant(0.7F);
  const double place = 4.0 * std::min(std::abs(share), 1.0);
  const auto below = std::min<std::size_t>(static_cast<std::size_t>(place), 3);
  const auto rest = static_cast<float>(place - static_cast<double>(below));
  return (1.0F - rest) * kScale[below] + rest * kScale[below + 1];
}

/// `light`: from 0 in the shade to 1 in the light.
std_msgs::ColorRGBA shaded(const Eigen::Vector3f& colour, double light) {
  const Eigen::Vector3f lit = static_cast<float>(kAmbient + (1.0 - kAmbient) * light) * colour;
  std_msgs::ColorRGBA out;
  out.r = lit.x();
  out.g = lit.y();
  out.b = lit.z();
  out.a = 1.0F;
  return out;
}

/// Nodes without a value get the mean of those with one in their facets, ring by ring.
Eigen::VectorXd interpolated(Eigen::VectorXd values, const TetMesh& mesh) {
  values.conservativeResizeLike(Eigen::VectorXd::Constant(mesh.nodes.cols(), std::numeric_limits<double>::quiet_NaN()));
  for (int ring = 0; ring < kRings; ++ring) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(values.size()), count = sum;
    for (Eigen::Index facet = 0; facet < mesh.facets.cols(); ++facet) {
      for (Eigen::Index i = 0; i < mesh.facets.rows(); ++i) {
        const int from = mesh.facets(i, facet);
        if (!std::isfinite(values[from])) continue;
        for (Eigen::Index j = 0; j < mesh.facets.rows(); ++j) {
          const int to = mesh.facets(j, facet);
          sum[to] += std::abs(values[from]);
          count[to] += 1.0;
        }
      }
    }
    for (Eigen::Index i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]) && count[i] > 0.0) values[i] = sum[i] / count[i];
    }
  }
  return values;
}

/// Returns how much each node of the surface faces a light above, 0 to 1. rviz does not shade triangles that have their own
/// colours.
Eigen::VectorXd lights(const TetMesh& mesh, const Eigen::Matrix3Xd& positions) {
  static const Eigen::Vector3d towards = Eigen::Vector3d(0.35, -0.45, 0.8).normalized();
  Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, positions.cols());
  for (Eigen::Index facet = 0; facet < mesh.facets.cols(); ++facet) {
    const auto corner = [&](int i) { return positions.col(mesh.facets(i, facet)); };
    const Eigen::Vector3d normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    for (Eigen::Index i = 0; i < mesh.facets.rows(); ++i) normals.col(mesh.facets(i, facet)) += normal;
  }
  Eigen::VectorXd out(positions.cols());
  for (Eigen::Index i = 0; i < out.size(); ++i) {
    const double length = normals.col(i).norm();
    out[i] = length > 0.0 ? std::max(0.0, normals.col(i).dot(towards) / length) : 0.0;
  }
  return out;
}

/// Returns the corner triples of a facet. A facet with mid nodes (corners 0-2, mid nodes of 01, 12, 20) has four.
std::vector<std::array<int, 3>> triangles(Eigen::Index facet_nodes) {
  if (facet_nodes == 6) return {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}, {3, 4, 5}};
  return {{0, 1, 2}};
}

/// Returns a cloud of `count` points with float fields and one integer field after them.
sensor_msgs::PointCloud2 empty_cloud(const std_msgs::Header& header, const std::vector<std::string>& reals,
                                     const std::string& integer, std::size_t count) {
  sensor_msgs::PointCloud2 cloud;
  cloud.header = header;
  cloud.height = 1;
  cloud.width = static_cast<std::uint32_t>(count);
  cloud.is_dense = 1;
  const auto add = [&](const std::string& name, std::uint8_t type) {
    sensor_msgs::PointField field;
    field.name = name;
    field.offset = cloud.point_step;
    field.datatype = type;
    field.count = 1;
    cloud.fields.push_back(field);
    cloud.point_step += 4;
  };
  for (const std::string& name : reals) add(name, sensor_msgs::PointField::FLOAT32);
  add(integer, sensor_msgs::PointField::INT32);
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.resize(cloud.row_step);
  return cloud;
}

double at(const Eigen::VectorXd& values, int node) {
  return node < values.size() ? values[node] : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

visualization_msgs::Marker painted_surface(const TetMesh& mesh, const Eigen::Matrix3Xd& positions,
                                           const std::function<Eigen::Vector3f(int node)>& colour, const std::string& name,
                                           const std_msgs::Header& header) {
  visualization_msgs::Marker marker;
  marker.header = header;
  marker.ns = name;
  marker.type = visualization_msgs::Marker::TRIANGLE_LIST;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color.a = 1.0F;
  const Eigen::VectorXd light = lights(mesh, positions);
  const auto parts = triangles(mesh.facets.rows());
  const std::size_t corners = 3 * parts.size() * static_cast<std::size_t>(mesh.facet_count());
  marker.points.reserve(corners);
  marker.colors.reserve(corners);
  for (int facet = 0; facet < mesh.facet_count(); ++facet) {
    for (const auto& part : parts) {
      for (const int corner : part) {
        const int node = mesh.facets(corner, facet);
        geometry_msgs::Point point;
        point.x = positions(0, node);
        point.y = positions(1, node);
        point.z = positions(2, node);
        marker.points.push_back(point);
        marker.colors.push_back(shaded(colour(node), light[node]));
      }
    }
  }
  return marker;
}

visualization_msgs::Marker surface_marker(const TetMesh& mesh, const Eigen::Matrix3Xd& displacement, const Misfit& misfit,
                                          double limit, const std_msgs::Header& header) {
  const Eigen::VectorXd sigmas = interpolated(misfit.node_sigmas, mesh);
  const auto colour = [&](int node) { return heat_colour(sigmas[node] / limit); };
  return painted_surface(mesh, mesh.nodes + displacement, colour, "tracked_surface", header);
}

sensor_msgs::PointCloud2 surface_cloud(const TetMesh& mesh, const Eigen::Matrix3Xd& displacement, const Misfit& misfit,
                                       const std_msgs::Header& header) {
  const std::set<int> surface(mesh.facets.data(), mesh.facets.data() + mesh.facets.size());
  sensor_msgs::PointCloud2 cloud =
      empty_cloud(header, {"x", "y", "z", "dx", "dy", "dz", "misfit", "misfit_sigma"}, "vertex", surface.size());
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "x");
  sensor_msgs::PointCloud2Iterator<std::int32_t> vertex(cloud, "vertex");
  for (const int node : surface) {
    const Eigen::Vector3f moved = displacement.col(node).cast<float>();
    const Eigen::Vector3f position = (mesh.nodes.col(node) + displacement.col(node)).cast<float>();
    for (int axis = 0; axis < 3; ++axis) {
      value[axis] = position[axis];
      value[3 + axis] = moved[axis];
    }
    value[6] = static_cast<float>(at(misfit.node_error, node));
    value[7] = static_cast<float>(at(misfit.node_sigmas, node));
    *vertex = node;
    ++value;
    ++vertex;
  }
  return cloud;
}

sensor_msgs::PointCloud2 measured_cloud(const Frame& frame, const std_msgs::Header& header) {
  std::size_t count = 0;
  for (const Observation& seen : frame.observations) count += static_cast<std::size_t>(seen.points.cols());
  sensor_msgs::PointCloud2 cloud = empty_cloud(header, {"x", "y", "z"}, "source", count);
  sensor_msgs::PointCloud2Iterator<float> value(cloud, "x");
  sensor_msgs::PointCloud2Iterator<std::int32_t> source(cloud, "source");
  for (const Observation& seen : frame.observations) {
    for (Eigen::Index i = 0; i < seen.points.cols(); ++i, ++value, ++source) {
      for (int axis = 0; axis < 3; ++axis) value[axis] = static_cast<float>(seen.points(axis, i));
      *source = seen.source;
    }
  }
  return cloud;
}

}  // namespace tissue_stiffness
