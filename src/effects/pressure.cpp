// Pressure of a fluid on a surface: a dead load for small strain, a follower load for finite strain.
#include <Eigen/Geometry>

#include "tissue_stiffness/effects/registry.hpp"
#include "tissue_stiffness/fem/facet_quadrature.hpp"

namespace tissue_stiffness::effects {
namespace {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

class Pressure : public Effect {
 public:
  Pressure(const Value& arguments, const EffectContext& context)
      : mesh_(context.mesh),
        fem_(context.fem),
        facets_(find_surface(arguments.at("region"), context.regions).facets),
        rule_(static_cast<int>(context.mesh.facets.rows())),
        course_(load_course(arguments, LoadInput::Kind::pressure, context)) {
    for (const int f : facets_) local_.push_back(facet_local_nodes(mesh_, f));
  }

  void linear_terms(LinearTerms& out) const override {
    Eigen::VectorXd pattern = Eigen::VectorXd::Zero(fem_.dof_count());
    add_unit_force(nullptr, 1.0, pattern);
    LoadTerm load;
    load.pattern = std::move(pattern);
    load.coefficient = [](const Parameters& p) { return p[0]; };
    load.course = course_;
    out.loads.push_back(std::move(load));
  }
  bool has_finite_form() const override { return true; }

  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    add_unit_force(&motion.displacement, pressure(motion, p), force);
  }

  // Symmetric part: exact but for the edge of the loaded surface.
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    const double now = pressure(motion, p);
    for (std::size_t i = 0; i < facets_.size(); ++i) add_facet_stiffness(i, motion.displacement, now, stiffness);
  }

 private:
  double pressure(const Motion& motion, const Parameters& p) const {
    return motion.load_factor * p[0] * course_->value(motion.time, 0);
  }

  void add_unit_force(const Eigen::VectorXd* u, double pressure, Eigen::VectorXd& force) const {
    for (const int f : facets_) {
      const FacetNodes x = facet_nodes(mesh_, f, u);
      for (int q = 0; q < rule_.points(); ++q) {
        const Eigen::Vector3d load = -pressure * rule_.weight(q) * rule_.normal(x, q);
        for (Eigen::Index a = 0; a < x.cols(); ++a) force.segment<3>(3 * mesh_.facets(a, f)) += rule_.shape(q)[a] * load;
      }
    }
  }

  void add_facet_stiffness(std::size_t i, const Eigen::VectorXd& u, double pressure, SparseMatrix& stiffness) const {
    const int f = facets_[i];
    const FacetNodes x = facet_nodes(mesh_, f, &u);
    const Eigen::Index n = x.cols();
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(3 * n, 3 * n);
    for (int q = 0; q < rule_.points(); ++q) {
      const Eigen::MatrixX2d& d = rule_.derivative(q);
      const Eigen::Matrix<double, 3, 2> t = x * d;
      const Eigen::Matrix3d c0 = cross_matrix(t.col(0)), c1 = cross_matrix(t.col(1));
      for (Eigen::Index b = 0; b < n; ++b) {
        const Eigen::Matrix3d turn = pressure * rule_.weight(q) * (d(b, 1) * c0 - d(b, 0) * c1);
        for (Eigen::Index a = 0; a < n; ++a) block.block<3, 3>(3 * a, 3 * b) += rule_.shape(q)[a] * turn;
      }
    }
    block = (0.5 * (block + block.transpose())).eval();
    for (Eigen::Index b = 0; b < n; ++b) {
      for (Eigen::Index a = 0; a < n; ++a) {
        fem_.add_block(stiffness, mesh_.facet_tet[f], local_[i][static_cast<std::size_t>(a)],
                       local_[i][static_cast<std::size_t>(b)], block.block<3, 3>(3 * a, 3 * b));
      }
    }
  }

  const TetMesh& mesh_;
  const Discretisation& fem_;
  std::vector<int> facets_;
  std::vector<std::vector<int>> local_;
  FacetQuadrature rule_;
  std::shared_ptr<Course> course_;
};

}  // namespace

EffectSpec pressure_spec() {
  EffectSpec spec;
  spec.name = "pressure";
  spec.summary = "measured pressure of a fluid on a surface; follows the surface when the strain is finite";
  spec.formula = "-scale p(t) int N_a n dA";
  spec.source = "Yang & Lin 2016, eq. 4, fourth term; follower load: Bonet & Wood 2008, sec. 8.5.2";
  spec.parameters = {{"scale", "s", "-", -1e3, 1e3, ParameterSpec::Default::optional, 1.0, 0.0, 1}};
  spec.keys = {{"region", "facets it pushes on"},
               {"topic", "sensor_msgs/FluidPressure, positive pushes on the tissue"},
               {"course", "{file: p.csv} with rows of time [s], pressure [Pa]; instead of topic"}};
  for (auto& key : load_error_keys("Pa", false)) spec.keys.push_back(std::move(key));
  return spec;
}

std::unique_ptr<Effect> make_pressure(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Pressure>(arguments, context);
}

}  // namespace tissue_stiffness::effects
