#pragma once

#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <Eigen/Core>
#include <functional>
#include <string>

#include "tissue_stiffness/types/misfit.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

// These functions show the tracked surface in rviz: rest mesh plus displacement [m], in the frame and at the stamp of
// `header`.

/// Returns a TRIANGLE_LIST of the surface at `positions` (3 x nodes [m]). Each node has the colour (red, green, blue, 0 to
/// 1) that `colour` returns for it, shaded by a light from above. A 10-node facet is shown as four triangles. `name`: its
/// namespace.
visualization_msgs::Marker painted_surface(const TetMesh& mesh, const Eigen::Matrix3Xd& positions,
                                           const std::function<Eigen::Vector3f(int node)>& colour, const std::string& name,
                                           const std_msgs::Header& header);

/// Returns a TRIANGLE_LIST coloured by misfit: blue at 0 sigma over cream to red at `limit` [sigma] and beyond. Colours are
/// interpolated between measured nodes and grey far from them.
visualization_msgs::Marker surface_marker(const TetMesh& mesh, const Eigen::Matrix3Xd& displacement, const Misfit& misfit,
                                          double limit, const std_msgs::Header& header);

/// Returns the surface's nodes with FLOAT32 fields x y z, dx dy dz (displacement), misfit (all in m), misfit_sigma and the
/// integer `vertex`. The misfit is NaN where nothing was measured.
sensor_msgs::PointCloud2 surface_cloud(const TetMesh& mesh, const Eigen::Matrix3Xd& displacement, const Misfit& misfit,
                                       const std_msgs::Header& header);

/// Returns every point that a frame measured, in the model frame, with FLOAT32 fields x y z [m] and the integer `source`,
/// the index in the model's list of observations.
sensor_msgs::PointCloud2 measured_cloud(const Frame& frame, const std_msgs::Header& header);

}  // namespace tissue_stiffness
