#include "nodes/message_conversions.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "meshing/tet_file_check.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

std::vector<float> to_floats(const Eigen::Ref<const Eigen::RowVectorXd, 0, Eigen::InnerStride<>>& row) {
  std::vector<float> out(static_cast<std::size_t>(row.size()));
  for (Eigen::Index i = 0; i < row.size(); ++i) out[static_cast<std::size_t>(i)] = static_cast<float>(row[i]);
  return out;
}

Eigen::RowVectorXd to_row(const std::vector<float>& values) {
  return Eigen::Map<const Eigen::RowVectorXf>(values.data(), static_cast<Eigen::Index>(values.size())).cast<double>();
}

void require_size(std::size_t size, std::size_t wanted, const std::string& where) {
  if (size != wanted) throw InputError(where, std::to_string(size) + " entries", std::to_string(wanted));
}

Eigen::MatrixXi to_indices(const std::vector<std::int32_t>& flat, int rows, int limit, const std::string& where) {
  if (flat.empty() || flat.size() % static_cast<std::size_t>(rows) != 0) {
    throw InputError(where, std::to_string(flat.size()) + " entries", "a multiple of " + std::to_string(rows) + ", not 0");
  }
  const auto wrong = std::find_if(flat.begin(), flat.end(), [&](std::int32_t i) { return i < 0 || i >= limit; });
  if (wrong != flat.end()) throw InputError(where, std::to_string(*wrong), "0 to " + std::to_string(limit - 1));
  return Eigen::Map<const Eigen::MatrixXi>(flat.data(), rows, static_cast<Eigen::Index>(flat.size()) / rows);
}

std::vector<std::int32_t> flat(const Eigen::Ref<const Eigen::MatrixXi>& indices) {
  const Eigen::MatrixXi packed = indices;
  return {packed.data(), packed.data() + packed.size()};
}

}  // namespace

ContourMessage to_message(const Contour& contour, const std_msgs::Header& header) {
  ContourMessage out;
  out.header = header;
  out.width = static_cast<std::uint32_t>(contour.width);
  out.height = static_cast<std::uint32_t>(contour.height);
  out.closed = static_cast<std::uint8_t>(contour.closed);
  out.u = to_floats(contour.points.row(0));
  out.v = to_floats(contour.points.row(1));
  out.normal_u = to_floats(contour.normals.row(0));
  out.normal_v = to_floats(contour.normals.row(1));
  out.sigma = to_floats(contour.sigma.transpose());
  return out;
}

Contour to_contour(const ContourMessage& message, const std::string& topic) {
  const std::size_t n = message.u.size();
  if (n < 3) throw InputError(topic + ": u", std::to_string(n) + " entries", "3 points or more");
  require_size(message.v.size(), n, topic + ": v");
  require_size(message.normal_u.size(), n, topic + ": normal_u");
  require_size(message.normal_v.size(), n, topic + ": normal_v");
  require_size(message.sigma.size(), n, topic + ": sigma");
  Contour out;
  out.stamp = message.header.stamp.toSec();
  out.width = static_cast<int>(message.width);
  out.height = static_cast<int>(message.height);
  out.closed = message.closed != 0;
  const auto columns = static_cast<Eigen::Index>(n);
  out.points.resize(2, columns);
  out.points << to_row(message.u), to_row(message.v);
  out.normals.resize(2, columns);
  out.normals << to_row(message.normal_u), to_row(message.normal_v);
  out.sigma = to_row(message.sigma).transpose();
  if (!out.points.allFinite()) throw InputError(topic + ": u, v", "a number that is not finite", "finite numbers");
  if (!out.normals.allFinite() || ((out.normals.colwise().norm().array() - 1.0).abs() > 1e-2).any()) {
    throw InputError(topic + ": normal_u, normal_v", "a normal whose length is not 1", "unit vectors");
  }
  if (!(out.sigma.array() > 0.0).all()) throw InputError(topic + ": sigma", "a number that is not > 0", "> 0 [pixel]");
  return out;
}

FeatureTracksMessage to_message(const FeatureTracks& tracks, const std_msgs::Header& header) {
  FeatureTracksMessage out;
  out.header = header;
  out.width = static_cast<std::uint32_t>(tracks.width);
  out.height = static_cast<std::uint32_t>(tracks.height);
  out.id.assign(tracks.ids.data(), tracks.ids.data() + tracks.ids.size());
  out.u = to_floats(tracks.pixels.row(0));
  out.v = to_floats(tracks.pixels.row(1));
  out.reference_u = to_floats(tracks.reference.row(0));
  out.reference_v = to_floats(tracks.reference.row(1));
  out.window = to_floats(tracks.windows.transpose());
  out.sigma = to_floats(tracks.sigma.transpose());
  return out;
}

FeatureTracks to_tracks(const FeatureTracksMessage& message, const std::string& topic) {
  const std::size_t n = message.id.size();
  require_size(message.u.size(), n, topic + ": u");
  require_size(message.v.size(), n, topic + ": v");
  require_size(message.reference_u.size(), n, topic + ": reference_u");
  require_size(message.reference_v.size(), n, topic + ": reference_v");
  require_size(message.window.size(), n, topic + ": window");
  require_size(message.sigma.size(), n, topic + ": sigma");
  FeatureTracks out;
  out.stamp = message.header.stamp.toSec();
  out.width = static_cast<int>(message.width);
  out.height = static_cast<int>(message.height);
  const auto columns = static_cast<Eigen::Index>(n);
  out.ids = Eigen::Map<const Eigen::VectorXi>(message.id.data(), columns);
  std::set<int> numbers;
  for (const int id : message.id) {
    if (!numbers.insert(id).second) throw InputError(topic + ": id", std::to_string(id) + " twice", "each number once");
  }
  out.pixels.resize(2, columns);
  out.pixels << to_row(message.u), to_row(message.v);
  out.reference.resize(2, columns);
  out.reference << to_row(message.reference_u), to_row(message.reference_v);
  out.windows = to_row(message.window).transpose();
  if (!out.windows.allFinite() || (out.windows.array() < 0.0).any())
    throw InputError(topic + ": window", "a number that is not finite and >= 0", ">= 0 [pixel]");
  out.sigma = to_row(message.sigma).transpose();
  if (!out.pixels.allFinite()) throw InputError(topic + ": u, v", "a number that is not finite", "finite numbers");
  if (!out.reference.allFinite())
    throw InputError(topic + ": reference_u, reference_v", "a number that is not finite", "finite numbers");
  if (!out.sigma.allFinite() || !(out.sigma.array() > 0.0).all())
    throw InputError(topic + ": sigma", "a number that is not finite and > 0", "> 0 [pixel]");
  return out;
}

TetMeshMessage to_message(const TetMesh& mesh, const std_msgs::Header& header) {
  TetMeshMessage out;
  out.header = header;
  out.nodes.resize(static_cast<std::size_t>(mesh.node_count()));
  for (int i = 0; i < mesh.node_count(); ++i) {
    geometry_msgs::Point& point = out.nodes[static_cast<std::size_t>(i)];
    point.x = mesh.nodes(0, i);
    point.y = mesh.nodes(1, i);
    point.z = mesh.nodes(2, i);
  }
  out.corner_count = static_cast<std::uint32_t>(mesh.corner_count);
  out.nodes_per_tet = static_cast<std::uint8_t>(mesh.tets.rows());
  out.tets = flat(mesh.tets);
  out.facets = flat(mesh.facets);
  out.facet_tet = flat(mesh.facet_tet);
  return out;
}

TetMesh to_mesh(const TetMeshMessage& message, const std::string& topic) {
  if (message.nodes_per_tet != 4 && message.nodes_per_tet != 10) {
    throw InputError(topic + ": nodes_per_tet", std::to_string(message.nodes_per_tet), "4 or 10");
  }
  if (message.nodes.size() < 4) {
    throw InputError(topic + ": nodes", std::to_string(message.nodes.size()) + " entries", "4 or more");
  }
  TetMesh out;
  const int nodes = static_cast<int>(message.nodes.size());
  out.nodes.resize(3, nodes);
  for (int i = 0; i < nodes; ++i) {
    const geometry_msgs::Point& point = message.nodes[static_cast<std::size_t>(i)];
    out.nodes.col(i) << point.x, point.y, point.z;
    if (!out.nodes.col(i).allFinite()) {
      throw InputError(topic + ": nodes[" + std::to_string(i) + "]", "a coordinate that is not finite", "finite numbers");
    }
  }
  if (message.corner_count > message.nodes.size()) {
    throw InputError(topic + ": corner_count", std::to_string(message.corner_count), "at most " + std::to_string(nodes));
  }
  out.corner_count = static_cast<int>(message.corner_count);
  out.tets = to_indices(message.tets, message.nodes_per_tet, nodes, topic + ": tets");
  out.facets = to_indices(message.facets, message.nodes_per_tet == 10 ? 6 : 3, nodes, topic + ": facets");
  require_size(message.facet_tet.size(), static_cast<std::size_t>(out.facet_count()), topic + ": facet_tet");
  out.facet_tet = to_indices(message.facet_tet, 1, out.tet_count(), topic + ": facet_tet").transpose();
  check_tet_mesh(out, topic);
  return out;
}

StiffnessEstimate to_message(const Estimate& estimate, const std_msgs::Header& header) {
  StiffnessEstimate out;
  out.header = header;
  out.state = to_string(estimate.state);
  out.state_reason = estimate.state_reason;
  for (const ParameterEstimate& parameter : estimate.parameters) {
    out.names.push_back(parameter.name);
    out.units.push_back(parameter.unit);
    out.mean.push_back(parameter.mean);
    out.std.push_back(parameter.std);
    out.lower95.push_back(parameter.lower95);
    out.upper95.push_back(parameter.upper95);
  }
  const Eigen::MatrixXd rows = estimate.covariance.transpose();
  out.covariance.assign(rows.data(), rows.data() + rows.size());
  const auto modulus = std::find_if(estimate.parameters.begin(), estimate.parameters.end(),
                                    [](const ParameterEstimate& p) { return is_young_modulus(p.name); });
  const bool found = modulus != estimate.parameters.end();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  out.young_modulus = found ? modulus->mean : nan;
  out.young_modulus_std = found ? modulus->std : nan;
  out.young_modulus_lower95 = found ? modulus->lower95 : nan;
  out.young_modulus_upper95 = found ? modulus->upper95 : nan;
  return out;
}

MisfitMessage to_message(const Misfit& misfit, const std_msgs::Header& header) {
  MisfitMessage out;
  out.header = header;
  out.count = static_cast<std::uint32_t>(misfit.count);
  out.outliers = static_cast<std::uint32_t>(misfit.outliers);
  out.rms = misfit.rms;
  out.rms_sigma = misfit.rms_sigma;
  out.motion_rms = misfit.motion_rms;
  out.relative = misfit.motion_rms > 0.0 ? misfit.rms / misfit.motion_rms : std::numeric_limits<double>::quiet_NaN();
  out.nis = misfit.nis;
  out.dof = static_cast<std::uint32_t>(misfit.dof);
  return out;
}

}  // namespace tissue_stiffness
