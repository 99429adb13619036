#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "effects/effect.hpp"
#include "effects/rigid_contact.hpp"

namespace tissue_stiffness {

using ToolPose = Eigen::Matrix<double, 3, 4>;  ///< [R | c]: a point x of the tool's frame is at R x + c

/// The shape of a rigid tool in its own frame.
class ToolShape {
 public:
  virtual ~ToolShape() = default;
  /// Returns the tool at a pose. `radius` is that of a ball, capsule or cylinder [m]. Distances from a surface are exact
  /// up to `margin` outside of the box around it, and too small beyond.
  virtual std::shared_ptr<const Obstacle> at(const ToolPose& pose, double radius, double margin) const = 0;
  /// Returns points of which one travels at least as far as any part of the tool that touches, 3 x k [m].
  virtual Eigen::Matrix3Xd extremes() const = 0;
  /// Returns the size of what a contact has to resolve [m].
  virtual double size() const = 0;
};

/// Returns the keys of a tool's shape and the values they take.
std::vector<std::pair<std::string, std::string>> tool_shape_keys();
/// Reads the shape of a tool. Throws InputError for a key that is missing, or for a file that holds no closed surface.
std::unique_ptr<const ToolShape> read_tool_shape(const Value& arguments, const EffectContext& context);

}  // namespace tissue_stiffness
