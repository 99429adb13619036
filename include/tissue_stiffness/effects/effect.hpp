#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/effects/course.hpp"
#include "tissue_stiffness/fem/discretisation.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// One number of an effect: from it follow the YAML key, the filter's layout and the documentation.
struct ParameterSpec {
  std::string name;
  std::string symbol;
  std::string unit;
  double lower = 0.0;  ///< smallest value allowed
  double upper = 0.0;  ///< largest value allowed
  enum class Default { required, optional } presence = Default::required;
  double value = 0.0;   ///< when the key is absent and optional
  double absent = 0.0;  ///< value at which the model without the effect comes back; NaN where there is none
  int components = 1;   ///< 3: a vector [x, y, z], parameters name_x, name_y, name_z
};

/// What an effect is, in words and numbers.
struct EffectSpec {
  std::string name;
  std::string summary;
  std::string formula;
  std::string source;
  std::vector<ParameterSpec> parameters;
  std::vector<std::pair<std::string, std::string>> keys;  ///< further keys and what they take
};

/// What an effect may look at while it is built.
struct EffectContext {
  const TetMesh& mesh;
  const Discretisation& fem;
  const std::map<std::string, Region>& regions;
  bool finite_strain;     ///< the model's elasticity is not small-strain
  double young_modulus;   ///< prior median [Pa], a scale for penalties
  std::string directory;  ///< of the model file, for relative paths
  CourseTable& courses;   ///< time courses by topic
  std::vector<LoadInput>& inputs;

  /// Throws InputError naming the key and the regions there are.
  const Region& region(const Value& name) const;
};

/// The effect's own parameter values, in the order of its spec, vectors spread out.
using Parameters = Eigen::Ref<const Eigen::VectorXd>;
using Coefficient = std::function<double(const Parameters&)>;

/// Contributions that are linear in displacement and velocity: coefficient(parameters) times a constant.
struct MatrixTerm {
  SparseMatrix matrix;
  Coefficient coefficient;
};
struct LoadTerm {
  Eigen::VectorXd pattern;  ///< nodal forces of a unit load, 3n
  Coefficient coefficient;
  std::shared_ptr<const Course> course;  ///< null: constant 1
  int component = 0;                     ///< of the course
};
struct LinearTerms {
  std::vector<MatrixTerm> mass;                ///< [kg]
  std::vector<MatrixTerm> stiffness;           ///< [N/m]; at rest, for damping too where the law is not linear
  std::vector<LoadTerm> loads;                 ///< [N]
  std::vector<Coefficient> acceleration[3];    ///< body acceleration [m/s^2]; its force is the whole mass matrix times it
  std::vector<Coefficient> mass_damping;       ///< alpha [1/s]
  std::vector<Coefficient> stiffness_damping;  ///< beta [s]
};

/// Instant at which a nonlinear effect is evaluated.
struct Motion {
  double time;
  const Eigen::VectorXd& displacement;  ///< 3n [m]
  const Eigen::VectorXd& velocity;      ///< 3n [m/s]
};

/// One physical effect of the model. Hooks are const and default to nothing.
class Effect {
 public:
  virtual ~Effect() = default;

  virtual void linear_terms(LinearTerms&) const {}
  /// Nodes held at rest.
  virtual std::vector<int> fixed_nodes() const { return {}; }

  /// True when the force below is not zero: the model is then integrated in full.
  virtual bool nonlinear() const { return false; }
  /// Elasticity only: true when `linear_terms` gives the rest stiffness for damping, while the force itself comes from
  /// add_force.
  virtual bool stiffness_is_reference() const { return false; }
  /// Adds the force [N] (external minus internal).
  virtual void add_force(const Motion&, const Parameters&, Eigen::VectorXd&) const {}
  /// Adds -d force / d displacement [N/m]; symmetric, pattern of the discretisation.
  virtual void add_stiffness(const Motion&, const Parameters&, SparseMatrix&) const {}
  /// Stored energy [J], where the effect has one.
  virtual double energy(const Motion&, const Parameters&) const { return 0.0; }
};

}  // namespace tissue_stiffness
