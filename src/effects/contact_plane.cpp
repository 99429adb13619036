// The surface is in contact with a rigid plane, by penalty at its quadrature points, with Coulomb's friction.
#include <cmath>

#include "effects/registry.hpp"
#include "fem/facet_quadrature.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness::effects {
namespace {

constexpr double kRelativePenalty = 10.0;  // of E over the facets' size, when `stiffness` is absent
constexpr double kSlow = 0.01;             // body sizes a second: what slides more slowly sticks, nearly

double mean_edge(const TetMesh& mesh) {
  double sum = 0.0;
  for (int f = 0; f < mesh.facet_count(); ++f) {
    sum += (mesh.nodes.col(mesh.facets(0, f)) - mesh.nodes.col(mesh.facets(1, f))).norm();
  }
  return sum / mesh.facet_count();
}

class ContactPlane : public Effect, public NonlinearForce {
 public:
  ContactPlane(const Value& arguments, const EffectContext& context)
      : mesh_(context.mesh),
        fem_(context.fem),
        rule_(static_cast<int>(context.mesh.facets.rows())),
        point_(arguments.at("point").as_vector3("m")),
        normal_(arguments.at("normal").as_vector3("-")),
        default_stiffness_(kRelativePenalty * context.young_modulus / mean_edge(context.mesh)),
        slow_(kSlow * body_size(context.mesh.nodes)) {
    if (!(normal_.norm() > 0.0)) {
      throw InputError(arguments.at("normal").path(), arguments.at("normal").shown(), "a vector that is not zero");
    }
    normal_.normalize();
    for (int f = 0; f < mesh_.facet_count(); ++f) local_.push_back(facet_local_nodes(mesh_, f));
  }

  const NonlinearForce* nonlinear_force() const override { return this; }
  bool has_velocity_tangent(const Parameters& p) const override { return p[2] > 0.0; }

  void add_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    visit(motion.displacement, p, [&](int f, int q, double gap, double weighted) {
      Eigen::Vector3d push = -weighted * gap * normal_;
      if (has_velocity_tangent(p)) {
        const Sliding slides = sliding(motion.velocity, f, q);
        push += p[2] * weighted * gap / slides.speed * slides.velocity;
      }
      for (Eigen::Index a = 0; a < mesh_.facets.rows(); ++a) {
        force.segment<3>(3 * mesh_.facets(a, f)) += rule_.shape(q)[a] * push;
      }
    });
  }

  /// Adds the stiffness without the change of friction with depth, which is not symmetric.
  void add_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    const Eigen::Matrix3d direction = normal_ * normal_.transpose();
    visit(motion.displacement, p,
          [&](int f, int q, double, double weighted) { add_to_pairs(f, q, weighted * direction, stiffness); });
  }

  void add_velocity_tangent(const Motion& motion, const Parameters& p, SparseMatrix& damping) const override {
    const Eigen::Matrix3d along = Eigen::Matrix3d::Identity() - normal_ * normal_.transpose();
    visit(motion.displacement, p, [&](int f, int q, double gap, double weighted) {
      const Sliding slides = sliding(motion.velocity, f, q);
      const Eigen::Vector3d direction = slides.velocity / slides.speed;
      add_to_pairs(f, q, -p[2] * weighted * gap / slides.speed * (along - direction * direction.transpose()), damping);
    });
  }

  double energy(const Motion& motion, const Parameters& p) const override {
    double sum = 0.0;
    visit(motion.displacement, p, [&](int, int, double gap, double weighted) { sum += 0.5 * weighted * gap * gap; });
    return sum;
  }

 private:
  // Calls act(facet, point, gap < 0, stiffness x area) where the surface is behind the plane.
  template <typename Act>
  void visit(const Eigen::VectorXd& u, const Parameters& p, const Act& act) const {
    const double stiffness = p[0] > 0.0 ? p[0] : default_stiffness_;
    for (int f = 0; f < mesh_.facet_count(); ++f) {
      const FacetNodes x = facet_nodes(mesh_, f, &u);
      const Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, 6> height =
          (normal_.transpose() * (x.colwise() - point_)).array() - p[1];
      if (height.minCoeff() > 0.5 * (height.maxCoeff() - height.minCoeff())) continue;  // cannot dip between nodes
      for (int q = 0; q < rule_.points(); ++q) {
        const double gap = height * rule_.shape(q);
        if (gap >= 0.0) continue;
        act(f, q, gap, stiffness * rule_.weight(q) * rule_.normal(facet_nodes(mesh_, f), q).norm());
      }
    }
  }

  // Adds N_a N_b block for each pair of the facet's nodes.
  void add_to_pairs(int f, int q, const Eigen::Matrix3d& block, SparseMatrix& matrix) const {
    const auto& local = local_[static_cast<std::size_t>(f)];
    for (std::size_t b = 0; b < local.size(); ++b) {
      for (std::size_t a = 0; a < local.size(); ++a) {
        const double n = rule_.shape(q)[static_cast<Eigen::Index>(a)] * rule_.shape(q)[static_cast<Eigen::Index>(b)];
        fem_.add_block(matrix, mesh_.facet_tet[f], local[a], local[b], n * block);
      }
    }
  }

  struct Sliding {
    Eigen::Vector3d velocity;  // along the plane [m/s]
    double speed;              // never zero
  };
  Sliding sliding(const Eigen::VectorXd& velocity, int f, int q) const {
    Eigen::Vector3d v = Eigen::Vector3d::Zero();
    for (Eigen::Index a = 0; a < mesh_.facets.rows(); ++a) {
      v += rule_.shape(q)[a] * velocity.segment<3>(3 * mesh_.facets(a, f));
    }
    v -= normal_.dot(v) * normal_;
    return {v, std::sqrt(v.squaredNorm() + slow_ * slow_)};
  }

  const TetMesh& mesh_;
  const Discretisation& fem_;
  FacetQuadrature rule_;
  Eigen::Vector3d point_, normal_;
  double default_stiffness_, slow_;
  std::vector<std::vector<int>> local_;
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
  return spec;
}

std::unique_ptr<Effect> make_contact_plane(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ContactPlane>(arguments, context);
}

}  // namespace tissue_stiffness::effects
