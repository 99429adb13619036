// A rigid tool, whose pose is measured, touches the surface wherever it is: a ball, a capsule or a flat punch.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "effects/registry.hpp"
#include "effects/rigid_contact.hpp"
#include "effects/solids.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kRelativePenalty = 100.0;                   // of E over the facets' size, when `stiffness` is absent
constexpr double kLeastRadius = 1e-5, kLargestRadius = 1.0;  // [m]
constexpr double kResolution = 0.25;                         // of the radius, for the quadrature
constexpr double kVelocityStep = 5e-4;                       // [s]
constexpr double kPathStep = 0.01;                           // [s] between the poses that a path is read at
constexpr LoadTolerance kExact{0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0};
enum Index { kRadius, kOffset, kStiffness, kFriction, kOwn };

using Pose = Eigen::Matrix<double, 3, 4>;

Eigen::Vector3d apply(const Pose& pose, const Eigen::Vector3d& point) {
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

/// A shape that moves with the tool.
template <typename Shape>
class MovingTool : public Shape {
 public:
  MovingTool(const Shape& shape, const Pose& now, const Pose& before, const Pose& after)
      : Shape(shape), now_(now), before_(before), after_(after) {}
  Eigen::Vector3d velocity(const Eigen::Vector3d& point) const override {
    const Eigen::Vector3d own = now_.leftCols<3>().inverse() * (point - now_.col(3));
    return (apply(after_, own) - apply(before_, own)) / (2.0 * kVelocityStep);
  }

 private:
  Pose now_, before_, after_;
};

class ToolContact : public RigidContact {
 public:
  ToolContact(const Value& arguments, const EffectContext& context)
      : RigidContact(context, find_surface(arguments.at("region"), context.regions).facets,
                     kResolution * arguments.at("radius").as_quantity(kLeastRadius, kLargestRadius, "m").value),
        region_(arguments.at("region").as_text()),
        course_(load_course(arguments, LoadInput::Kind::pose, context)),
        from_(arguments.at("center").as_vector3("m")),
        to_(arguments.has("end") ? arguments.at("end").as_vector3("m") : from_),
        size_(arguments.at("radius").as_quantity(kLeastRadius, kLargestRadius, "m").value),
        flat_(arguments.has("flat") && arguments.at("flat").as_boolean()),
        solids_(context.solids.size()) {
    if (flat_ && from_ == to_) {
      throw InputError(arguments.path() + ": flat", arguments.has("end") ? "center and end at one place" : "no end",
                       "the cylinder's two ends, `center` and `end`");
    }
    course_->set_smoothing(arguments.number_or("smoothing", MotionPath::usual_smoothing, 0.0, 10.0, "s"));
    course_->set_tolerance(kExact);  // `offset` and `radius` have tolerances instead
  }

  bool needs_elasticity() const override { return true; }
  std::string reacting_region() const override { return region_; }

 private:
  std::shared_ptr<const Obstacle> obstacle(double time, const Parameters& p) const override {
    const std::optional<Pose> pose = course_->pose(time);
    if (!pose) return nullptr;
    const Eigen::Vector3d from = apply(*pose, from_), to = apply(*pose, to_);
    if (flat_) return moving(Cylinder(from, to, p[kRadius]), time, *pose, p);
    return moving(Capsule(from, to, p[kRadius]), time, *pose, p);
  }
  double path(double from, double to) const override {
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kPathStep)));
    double length = 0.0;
    std::optional<Pose> last = course_->pose(from);
    for (int k = 1; k <= steps && last; ++k) {
      const std::optional<Pose> next = course_->pose(from + (to - from) * k / steps);
      const auto moved = [&](const Eigen::Vector3d& end) { return (apply(*next, end) - apply(*last, end)).norm(); };
      length += std::max(moved(from_), moved(to_));
      last = next;
    }
    return last ? length / size_ : std::numeric_limits<double>::infinity();
  }
  double offset(const Parameters& p) const override { return p[kOffset]; }

  template <typename Shape>
  std::shared_ptr<const Obstacle> moving(const Shape& shape, double time, const Pose& pose, const Parameters& p) const {
    if (!(friction(p) > 0.0)) return std::make_shared<const Shape>(shape);
    return std::make_shared<const MovingTool<Shape>>(shape, pose, *course_->pose(time - kVelocityStep),
                                                     *course_->pose(time + kVelocityStep));
  }

  // A penalty in proportion to the tissue's modulus: where the tool's motion is given, the shape does not depend on it.
  double penalty(const Parameters& p) const override {
    if (p[kStiffness] > 0.0) return p[kStiffness];
    return kRelativePenalty * mean_young_modulus(p, kOwn, solids_) / mean_edge();
  }
  double friction(const Parameters& p) const override { return p[kFriction]; }

  std::string region_;
  std::shared_ptr<Course> course_;
  Eigen::Vector3d from_, to_;  ///< in the tool's frame [m]
  double size_;                ///< radius that the model starts from [m]
  bool flat_;
  std::size_t solids_;
};

}  // namespace

EffectSpec tool_contact_spec() {
  EffectSpec spec;
  spec.name = "tool_contact";
  spec.summary = "a rigid tool whose pose is measured touches the surface: a ball, a capsule or a flat punch";
  spec.formula =
      "-k min(g, 0) (n - mu v / sqrt(v^2 + v0^2)) at each surface point, g its distance from the tool - offset, v along "
      "the tool, v0 a hundredth of the body's size a second";
  spec.source = "penalty method, Wriggers 2006, sec. 5.3.2, Coulomb's law regularised, sec. 5.2; force per rest area";
  spec.parameters = {
      {"radius", "R", "m", kLeastRadius, kLargestRadius, ParameterSpec::Default::required, 0.0, NAN, 1, 0.0, 0.005},
      {"offset", "g0", "m", -0.1, 0.1, ParameterSpec::Default::optional, 0.0, NAN, 1, 1e-4, 0.0},
      {"stiffness", "k", "N/m^3", 0.0, 1e15, ParameterSpec::Default::optional, 0.0, NAN, 1},
      {"friction", "mu", "-", 0.0, 10.0, ParameterSpec::Default::optional, 0.0, NAN, 1}};
  spec.keys = {
      {"region", "facets that it may touch"},
      {"topic", "geometry_msgs/PoseStamped"},
      {"course", "{file: f.csv} with rows of time [s], x, y, z [m] and a quaternion qx, qy, qz, qw; instead of topic"},
      {"smoothing", "half width of the quadratic that smoothes the poses [s]; 0.04 when absent, 0: as measured"},
      {"center", "[x, y, z] of the ball in the tool's frame, or of one end of a capsule's or cylinder's axis [m]"},
      {"end", "[x, y, z] of the other end [m]; a ball when absent"},
      {"flat", "true: a cylinder with flat ends; false when absent"}};
  spec.load = LoadInput::Kind::pose;
  spec.contact = true;
  return spec;
}

std::unique_ptr<Effect> make_tool_contact(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ToolContact>(arguments, context);
}

}  // namespace tissue_stiffness::effects
