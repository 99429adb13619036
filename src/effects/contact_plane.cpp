// The surface is in contact with a rigid plane, by penalty at its quadrature points, with Coulomb's friction.
#include <cmath>
#include <limits>
#include <numeric>

#include "effects/registry.hpp"
#include "effects/rigid_contact.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kRelativePenalty = 10.0;  // of E over the facets' size, when `stiffness` is absent
enum Index { kStiffness, kGap, kFriction };

class Plane : public Obstacle {
 public:
  Plane(Eigen::Vector3d point, Eigen::Vector3d normal) : point_(std::move(point)), normal_(std::move(normal)) {}
  Distance distance(const Eigen::Vector3d& point) const override {
    return {normal_.dot(point - point_), normal_, Eigen::Matrix3d::Zero()};
  }

 private:
  Eigen::Vector3d point_, normal_;
};

std::vector<int> all_facets(const TetMesh& mesh) {
  std::vector<int> out(static_cast<std::size_t>(mesh.facet_count()));
  std::iota(out.begin(), out.end(), 0);
  return out;
}

class ContactPlane : public RigidContact {
 public:
  ContactPlane(const Value& arguments, const EffectContext& context)
      : RigidContact(context, all_facets(context.mesh), std::numeric_limits<double>::infinity()),
        default_penalty_(kRelativePenalty * context.young_modulus / mean_edge()) {
    const Eigen::Vector3d normal = arguments.at("normal").as_vector3("-");
    if (!(normal.norm() > 0.0)) {
      throw InputError(arguments.at("normal").path(), arguments.at("normal").shown(), "a vector that is not zero");
    }
    plane_ = std::make_shared<const Plane>(arguments.at("point").as_vector3("m"), normal.normalized());
  }

 private:
  std::shared_ptr<const Obstacle> obstacle(double /*time*/, const Parameters& /*p*/) const override { return plane_; }
  double path(double /*from*/, double /*to*/) const override { return 0.0; }
  double offset(const Parameters& p) const override { return p[kGap]; }
  double penalty(const Parameters& p) const override { return p[kStiffness] > 0.0 ? p[kStiffness] : default_penalty_; }
  double friction(const Parameters& p) const override { return p[kFriction]; }

  double default_penalty_;
  std::shared_ptr<const Obstacle> plane_;
};

}  // namespace

EffectSpec contact_plane_spec() {
  EffectSpec spec;
  spec.name = "contact_plane";
  spec.summary = "contact with a rigid plane, with or without friction";
  spec.formula =
      "-k min(g, 0) (n - mu v / sqrt(v^2 + v0^2)) at each surface point, g = (x - point) . n - gap, v along the plane, "
      "v0 a hundredth of the body's size a second";
  spec.source = "penalty method, Wriggers 2006, sec. 5.3.2, Coulomb's law regularised, sec. 5.2; force per rest area";
  spec.parameters = {{"stiffness", "k", "N/m^3", 0.0, 1e15, ParameterSpec::Default::optional, 0.0, NAN, 1},
                     {"gap", "g0", "m", -1.0, 1.0, ParameterSpec::Default::optional, 0.0, NAN, 1},
                     {"friction", "mu", "-", 0.0, 10.0, ParameterSpec::Default::optional, 0.0, NAN, 1}};
  spec.keys = {{"point", "[x, y, z] on the plane [m]"}, {"normal", "[x, y, z] towards the body"}};
  spec.contact = true;
  return spec;
}

std::unique_ptr<Effect> make_contact_plane(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ContactPlane>(arguments, context);
}

}  // namespace tissue_stiffness::effects
