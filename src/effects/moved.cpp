// A region of the surface follows a rigid body whose pose is measured: a grasp, a moving base, a bonded tool. It is firm,
// or an elastic layer is between.
#include <cmath>

#include "effects/registry.hpp"
#include "effects/solids.hpp"
#include "fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kStiff =
    3e3;  // times the body's stiffness across a patch of this size: the region lags by a share of 3e-4
enum Index { kCompliance, kOwn };
constexpr int kMotions = 12;  // components of a rigid motion: d, and the columns of R - I

class Moved : public Effect {
 public:
  Moved(const Value& arguments, const EffectContext& context)
      : region_(arguments.at("region").as_text()),
        course_(load_course(arguments, LoadInput::Kind::pose, context)),
        solids_(context.solids.size()) {
    course_->set_smoothing(arguments.number_or("smoothing", MotionPath::usual_smoothing, 0.0, 10.0, "s"));
    SparseMatrix springs = facet_mass(context.mesh, find_surface(arguments.at("region"), context.regions).facets);
    firmness_ = kStiff / std::sqrt(springs.sum() / 3.0);
    springs_ = share_matrix(std::move(springs));
    patterns_ = *springs_ * rigid_motions(context.mesh);
  }

  bool needs_elasticity() const override { return true; }
  void linear_terms(LinearTerms& out) const override {
    // Springs in proportion to the tissue's modulus: where the motion is given, the shape does not depend on it.
    const auto stiffness = [this](const Parameters& p) {
      return 1.0 / (1.0 / (firmness_ * mean_young_modulus(p, kOwn, solids_)) + p[kCompliance]);
    };
    out.stiffness.push_back({springs_, stiffness, false});
    for (int i = 0; i < kMotions; ++i) {
      LoadTerm load;
      load.pattern = patterns_.col(i);
      load.coefficient = stiffness;
      load.course = course_;
      load.component = i;
      load.prescribed = true;
      out.loads.push_back(std::move(load));
    }
    out.guided_region = region_;
  }

 private:
  static Eigen::MatrixXd rigid_motions(const TetMesh& mesh) {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(3 * mesh.node_count(), kMotions);
    for (int node = 0; node < mesh.node_count(); ++node) {
      for (int i = 0; i < 3; ++i) {
        out(3 * node + i, i) = 1.0;
        for (int j = 0; j < 3; ++j) out(3 * node + i, 3 + 3 * j + i) = mesh.nodes(j, node);
      }
    }
    return out;
  }

  std::string region_;
  std::shared_ptr<Course> course_;
  std::size_t solids_;
  double firmness_ = 0.0;                        ///< stiffness per area, for a modulus of 1 Pa [1/m]
  std::shared_ptr<const SparseMatrix> springs_;  ///< for 1 N/m^3 [m^2]
  Eigen::MatrixXd patterns_;                     ///< their force for a unit of each component of the motion, 3n x 12
};

}  // namespace

EffectSpec moved_spec() {
  EffectSpec spec;
  spec.name = "moved";
  spec.summary = "a region follows a rigid body whose pose is measured: a grasp, a shaken base, a bonded tool";
  spec.formula = "s int N_a (d(t) + (R(t) - I) X - u) dA, 1/s = sqrt(A) / (3e3 E) + c; d, R since rest";
  spec.source = "Dirichlet condition by a penalty: Babuska 1973";
  spec.parameters = {{"compliance", "c", "m^3/N", 0.0, 1.0, ParameterSpec::Default::optional, 0.0, NAN, 1}};
  spec.keys = {
      {"region", "facets that follow"},
      {"topic", "geometry_msgs/PoseStamped"},
      {"course", "{file: f.csv} with rows of time [s], x, y, z [m] and a quaternion qx, qy, qz, qw; instead of topic"},
      {"smoothing", "half width of the quadratic that smoothes the poses [s]; 0.04 when absent, 0: as measured"}};
  spec.load = LoadInput::Kind::pose;
  for (auto& key : motion_error_keys()) spec.keys.push_back(std::move(key));
  return spec;
}

std::unique_ptr<Effect> make_moved(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Moved>(arguments, context);
}

}  // namespace tissue_stiffness::effects
