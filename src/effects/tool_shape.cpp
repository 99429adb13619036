#include "effects/tool_shape.hpp"

#include <algorithm>
#include <cmath>

#include "meshing/signed_distance.hpp"
#include "settings/inside_folder.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/nearest_rotation.hpp"

namespace tissue_stiffness {
namespace {

Eigen::Vector3d apply(const ToolPose& pose, const Eigen::Vector3d& point) {
  return pose.leftCols<3>() * point + pose.col(3);
}

/// All points within `radius` of the segment from `from` to `to`; a ball where both are one.
class Capsule : public Obstacle {
 public:
  Capsule(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius)
      : from_(from), axis_(to - from), radius_(radius) {}

  Distance distance(const Eigen::Vector3d& point) const override {
    const Eigen::Vector3d out = point - from_;
    const double length = axis_.squaredNorm(), s = length > 0.0 ? axis_.dot(out) / length : 0.0;
    const Eigen::Vector3d off = out - std::clamp(s, 0.0, 1.0) * axis_;
    const double far = std::max(off.norm(), 1e-12);
    const Eigen::Vector3d n = off / far;
    Eigen::Matrix3d curvature = Eigen::Matrix3d::Identity() - n * n.transpose();
    if (s > 0.0 && s < 1.0) curvature -= axis_ * axis_.transpose() / length;
    return {far - radius_, n, curvature / far};
  }

 private:
  Eigen::Vector3d from_, axis_;
  double radius_;
};

/// A cylinder with flat ends at `from` and `to`.
class Cylinder : public Obstacle {
 public:
  Cylinder(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double radius)
      : from_(from), length_((to - from).norm()), direction_((to - from) / length_), radius_(radius) {}

  Distance distance(const Eigen::Vector3d& point) const override {
    const double s = direction_.dot(point - from_);
    const Eigen::Vector3d off = point - from_ - s * direction_;
    const double far = std::max(off.norm(), 1e-12), beyond_side = far - radius_, beyond_end = std::max(-s, s - length_);
    if (beyond_side > 0.0 && beyond_end > 0.0) {  // nearest is the rim, which only a point outside may have
      const double gap = std::hypot(beyond_side, beyond_end);
      return {gap, (beyond_side * off / far + beyond_end * end_normal(s)) / gap, Eigen::Matrix3d::Zero()};
    }
    if (beyond_end >= beyond_side) return {beyond_end, end_normal(s), Eigen::Matrix3d::Zero()};
    const Eigen::Vector3d n = off / far;
    return {beyond_side, n, (Eigen::Matrix3d::Identity() - n * n.transpose() - direction_ * direction_.transpose()) / far};
  }

 private:
  Eigen::Vector3d end_normal(double s) const { return 2.0 * s < length_ ? Eigen::Vector3d(-direction_) : direction_; }

  Eigen::Vector3d from_;
  double length_;
  Eigen::Vector3d direction_;
  double radius_;
};

/// A closed surface that moves with the tool. Between measured poses the columns of R are interpolated, which leaves them
/// nearly orthonormal.
class SurfaceTool : public Obstacle {
 public:
  SurfaceTool(std::shared_ptr<const SignedDistance> surface, const ToolPose& pose, double margin)
      : surface_(std::move(surface)), turn_(nearest_rotation(pose.leftCols<3>())), place_(pose.col(3)), margin_(margin) {}

  Distance distance(const Eigen::Vector3d& point) const override {
    const SignedDistance::Value own = (*surface_)(turn_.transpose() * (point - place_), margin_);
    return {own.distance, turn_ * own.gradient, turn_ * own.curvature * turn_.transpose()};
  }

 private:
  std::shared_ptr<const SignedDistance> surface_;
  Eigen::Matrix3d turn_;
  Eigen::Vector3d place_;
  double margin_;
};

/// A ball, a capsule, or a cylinder with flat ends.
class RoundShape : public ToolShape {
 public:
  RoundShape(const Value& arguments, bool flat)
      : from_(arguments.at("center").as_vector3("m")),
        to_(arguments.has("end") ? arguments.at("end").as_vector3("m") : from_),
        size_(arguments.at("radius").as_quantity(0.0, 1.0, "m").value),
        flat_(flat) {
    if (!(size_ > 0.0)) throw InputError(arguments.at("radius").path(), arguments.at("radius").shown(), "> 0 m");
    if (flat_ && from_ == to_) {
      throw InputError(arguments.path() + ": flat", arguments.has("end") ? "center and end at one place" : "no end",
                       "the cylinder's two ends, `center` and `end`");
    }
  }

  std::shared_ptr<const Obstacle> at(const ToolPose& pose, double radius, double /*margin*/) const override {
    const Eigen::Vector3d from = apply(pose, from_), to = apply(pose, to_);
    if (flat_) return std::make_shared<const Cylinder>(from, to, radius);
    return std::make_shared<const Capsule>(from, to, radius);
  }
  Eigen::Matrix3Xd extremes() const override { return (Eigen::Matrix3Xd(3, 2) << from_, to_).finished(); }
  double size() const override { return size_; }

 private:
  Eigen::Vector3d from_, to_;  ///< in the tool's frame [m]
  double size_;                ///< radius that the model starts from [m]
  bool flat_;
};

/// The tool of a surface file.
class SurfaceShape : public ToolShape {
 public:
  explicit SurfaceShape(const TriangleSurface& surface) : surface_(std::make_shared<const SignedDistance>(surface)) {}

  std::shared_ptr<const Obstacle> at(const ToolPose& pose, double /*radius*/, double margin) const override {
    return std::make_shared<const SurfaceTool>(surface_, pose, margin);
  }
  Eigen::Matrix3Xd extremes() const override {
    Eigen::Matrix3Xd out(3, 8);
    for (int corner = 0; corner < 8; ++corner) {
      for (int i = 0; i < 3; ++i) out(i, corner) = (corner >> i & 1) != 0 ? surface_->high()[i] : surface_->low()[i];
    }
    return out;
  }
  double size() const override { return 0.5 * (surface_->high() - surface_->low()).minCoeff(); }

 private:
  std::shared_ptr<const SignedDistance> surface_;
};

}  // namespace

std::vector<std::pair<std::string, std::string>> tool_shape_keys() {
  return {{"center", "[x, y, z] of the ball in the tool's frame, or of one end of a capsule's or cylinder's axis [m]"},
          {"end", "[x, y, z] of the other end [m]; a ball when absent"},
          {"flat", "true: a cylinder with flat ends; false when absent"},
          {"surface",
           "{file: tool.stl, scale: 0.001}, a closed surface in the tool's frame (.stl, .ply, .obj) and what converts its "
           "lengths to metres, 1 when absent; in place of `radius`, `center`, `end` and `flat`"}};
}

std::unique_ptr<const ToolShape> read_tool_shape(const Value& arguments, const EffectContext& context) {
  if (!arguments.has("surface"))
    return std::make_unique<const RoundShape>(arguments, arguments.has("flat") && arguments.at("flat").as_boolean());
  for (const char* key : {"radius", "center", "end", "flat"}) {
    if (!arguments.has(key)) continue;
    throw InputError(arguments.at(key).path(), arguments.at(key).shown(), std::string("no `") + key + "` beside `surface`");
  }
  const Value& surface = arguments.at("surface");
  const std::string file = path_from(context.settings.directory, surface.at("file").as_text());
  return std::make_unique<const SurfaceShape>(load_surface(file, surface.number_or("scale", 1.0, 1e-6, 1e6, "m")));
}

}  // namespace tissue_stiffness
