// A rigid tool, whose pose is measured, touches the surface wherever it is.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "effects/registry.hpp"
#include "effects/rigid_contact.hpp"
#include "effects/solids.hpp"
#include "effects/tool_shape.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kRelativePenalty = 100.0;  // of E over the facets' size, when `stiffness` is absent
constexpr double kResolution = 0.25;        // of the tool's size, for the quadrature
constexpr double kVelocityStep = 5e-4;      // [s]
constexpr double kPathStep = 0.01;          // [s] between the poses that a path is read at
constexpr LoadTolerance kExact{0.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0};
enum Index { kRadius, kOffset, kStiffness, kFriction, kOwn };

/// A tool that drags the tissue along.
class MovingTool : public Obstacle {
 public:
  MovingTool(std::shared_ptr<const Obstacle> shape, const ToolPose& now, const ToolPose& before, const ToolPose& after)
      : shape_(std::move(shape)), now_(now), rate_((after - before) / (2.0 * kVelocityStep)) {}
  Distance distance(const Eigen::Vector3d& point) const override { return shape_->distance(point); }
  Eigen::Vector3d velocity(const Eigen::Vector3d& point) const override {
    return rate_.leftCols<3>() * (now_.leftCols<3>().inverse() * (point - now_.col(3))) + rate_.col(3);
  }

 private:
  std::shared_ptr<const Obstacle> shape_;
  ToolPose now_, rate_;
};

class ToolContact : public RigidContact {
 public:
  ToolContact(const Value& arguments, const EffectContext& context)
      : ToolContact(arguments, context, read_tool_shape(arguments, context)) {}

  bool needs_elasticity() const override { return true; }
  std::string reacting_region() const override { return region_; }

 private:
  ToolContact(const Value& arguments, const EffectContext& context, std::unique_ptr<const ToolShape> shape)
      : RigidContact(context, find_surface(arguments.at("region"), context.regions).facets, kResolution * shape->size()),
        region_(arguments.at("region").as_text()),
        course_(load_course(arguments, LoadInput::Kind::pose, context)),
        shape_(std::move(shape)),
        solids_(context.solids.size()) {
    course_->set_smoothing(arguments.number_or("smoothing", MotionPath::usual_smoothing, 0.0, 10.0, "s"));
    course_->set_tolerance(kExact);  // `offset` and `radius` have tolerances instead
  }

  std::shared_ptr<const Obstacle> obstacle(double time, const Parameters& p) const override {
    const std::optional<ToolPose> pose = course_->pose(time);
    if (!pose) return nullptr;
    std::shared_ptr<const Obstacle> tool = shape_->at(*pose, p[kRadius], std::max(0.0, p[kOffset]));
    if (!(friction(p) > 0.0)) return tool;
    return std::make_shared<const MovingTool>(std::move(tool), *pose, *course_->pose(time - kVelocityStep),
                                              *course_->pose(time + kVelocityStep));
  }
  double path(double from, double to) const override {
    const Eigen::Matrix3Xd points = shape_->extremes();
    const auto placed = [&points](const ToolPose& pose) {
      return Eigen::Matrix3Xd((pose.leftCols<3>() * points).colwise() + pose.col(3));
    };
    const int steps = std::max(1, static_cast<int>(std::ceil((to - from) / kPathStep)));
    double length = 0.0;
    std::optional<ToolPose> last = course_->pose(from);
    for (int k = 1; k <= steps && last; ++k) {
      const std::optional<ToolPose> next = course_->pose(from + (to - from) * k / steps);
      length += (placed(*next) - placed(*last)).colwise().norm().maxCoeff();
      last = next;
    }
    return last ? length / shape_->size() : std::numeric_limits<double>::infinity();
  }
  double offset(const Parameters& p) const override { return p[kOffset]; }

  // A penalty in proportion to the tissue's modulus: where the tool's motion is given, the shape does not depend on it.
  double penalty(const Parameters& p) const override {
    if (p[kStiffness] > 0.0) return p[kStiffness];
    return kRelativePenalty * mean_young_modulus(p, kOwn, solids_) / mean_edge();
  }
  double friction(const Parameters& p) const override { return p[kFriction]; }

  std::string region_;
  std::shared_ptr<Course> course_;
  std::unique_ptr<const ToolShape> shape_;
  std::size_t solids_;
};

}  // namespace

EffectSpec tool_contact_spec() {
  EffectSpec spec;
  spec.name = "tool_contact";
  spec.summary =
      "a rigid tool whose pose is measured touches the surface: a ball, a capsule, a flat punch, or what a surface file "
      "holds";
  spec.formula =
      "-k min(g, 0) (n - mu v / sqrt(v^2 + v0^2)) at each surface point, g its distance from the tool - offset, v along "
      "the tool, v0 a hundredth of the body's size a second";
  spec.source = "penalty method, Wriggers 2006, sec. 5.3.2, Coulomb's law regularised, sec. 5.2; force per rest area";
  spec.parameters = {{"radius", "R", "m", 0.0, 1.0, ParameterSpec::Default::optional, 0.0, NAN, 1, 0.0, 0.005},
                     {"offset", "g0", "m", -0.1, 0.1, ParameterSpec::Default::optional, 0.0, NAN, 1, 1e-4, 0.0},
                     {"stiffness", "k", "N/m^3", 0.0, 1e15, ParameterSpec::Default::optional, 0.0, NAN, 1},
                     {"friction", "mu", "-", 0.0, 10.0, ParameterSpec::Default::optional, 0.0, NAN, 1}};
  spec.keys = {
      {"region", "facets that it may touch"},
      {"topic", "geometry_msgs/PoseStamped"},
      {"course", "{file: f.csv} with rows of time [s], x, y, z [m] and a quaternion qx, qy, qz, qw; instead of topic"},
      {"smoothing", "half width of the quadratic that smoothes the poses [s]; 0.04 when absent, 0: as measured"}};
  for (auto& key : tool_shape_keys()) spec.keys.push_back(std::move(key));
  spec.load = LoadInput::Kind::pose;
  spec.contact = true;
  return spec;
}

std::unique_ptr<Effect> make_tool_contact(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ToolContact>(arguments, context);
}

}  // namespace tissue_stiffness::effects
