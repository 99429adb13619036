#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/effects/course.hpp"
#include "tissue_stiffness/effects/proposal.hpp"
#include "tissue_stiffness/effects/terms.hpp"
#include "tissue_stiffness/fem/discretisation.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// One number of an effect. The YAML key, the filter's layout and the documentation follow from it.
struct ParameterSpec {
  std::string name;
  std::string symbol;
  std::string unit;
  double lower = 0.0;  ///< smallest value allowed
  double upper = 0.0;  ///< largest value allowed
  enum class Default { required, optional } presence = Default::required;
  double value = 0.0;   ///< default of an optional key
  double absent = 0.0;  ///< value at which the model is that without the effect; NaN where there is none
  int components = 1;   ///< 3: a vector [x, y, z] with parameters name_x, name_y, name_z
  /// Default tolerance (1 sigma) of a declared number. The share is relative to the number's size.
  double tolerance = 0.0, tolerance_share = 0.0;
};

/// Description of an effect in words and numbers.
struct EffectSpec {
  std::string name;
  std::string summary;
  std::string formula;
  std::string source;
  std::vector<ParameterSpec> parameters;
  std::vector<std::pair<std::string, std::string>> keys;  ///< further keys and their values
  Proposer proposals = nullptr;                           ///< null: its absence is not searched for
  bool of_simulation = false;                             ///< not physics, but a property of simulated recordings
};

/// What is available to an effect while it is built.
struct EffectContext {
  const TetMesh& mesh;
  const Discretisation& fem;
  const std::map<std::string, Region>& regions;
  const ModelSettings& settings;         ///< settings of the whole model file
  std::vector<std::vector<int>> solids;  ///< tetrahedra of each elasticity, in order
  double young_modulus;                  ///< prior median [Pa], a scale for penalty stiffnesses
  CourseTable& courses;                  ///< time courses by topic
  std::vector<LoadInput>& inputs;

  /// Returns the region. Throws InputError naming the key and the existing regions.
  const Region& region(const Value& name) const;
};

/// State of the motion at which a nonlinear effect is evaluated.
struct Motion {
  double time;
  const Eigen::VectorXd& displacement;  ///< 3n [m]
  const Eigen::VectorXd& velocity;      ///< 3n [m/s]
  double finite_share = 0.0;            ///< share of finite strain, 0 to 1
  double load_factor = 1.0;             ///< factor of every measured load
  double since = 0.0;                   ///< time since the recording's first stamp [s]
};

/// The motion as a sensor observes it. Effects of the observation change it in place, in the order of the model file.
struct ObservedMotion {
  const TetMesh& mesh;
  double time;                   ///< since the model's start [s]
  Eigen::VectorXd displacement;  ///< apparent displacement, 3n [m]
  double outward = 0.0;          ///< shift of outlines and surface points along their outward normal [m]
};

/// One physical effect of the model. Its functions are const and do nothing by default.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Returns whether the effect depends only on its own entry, the mesh and its regions, and never changes. Then models of
  /// one body may share it.
  virtual bool shareable() const { return false; }

  virtual void linear_terms(LinearTerms&) const {}
  /// Returns whether the parameters of the model's elasticities follow the effect's own.
  virtual bool needs_elasticity() const { return false; }
  /// Nodes held at rest, and nodes of other effects that it releases while is_compliant() is true.
  virtual std::vector<int> fixed_nodes() const { return {}; }
  virtual std::vector<int> compliant_nodes() const { return {}; }
  virtual bool is_compliant(const Parameters&) const { return false; }

  /// Returns whether the two functions below replace the linear stiffness and loads under finite strain.
  virtual bool has_finite_form() const { return false; }
  /// Only for elasticity: returns whether its law requires finite strain.
  virtual bool always_finite() const { return false; }
  virtual void add_finite_force(const Motion&, const Parameters&, Eigen::VectorXd&) const {}
  virtual void add_finite_stiffness(const Motion&, const Parameters&, SparseMatrix&) const {}

  /// Returns whether the force below is not zero. The model is then integrated in full.
  virtual bool nonlinear() const { return false; }
  /// Adds the force [N] (external minus internal) that is not a linear term.
  virtual void add_force(const Motion&, const Parameters&, Eigen::VectorXd&) const {}
  /// Adds -d force / d displacement [N/m], which is symmetric and has the pattern of the discretisation.
  virtual void add_stiffness(const Motion&, const Parameters&, SparseMatrix&) const {}
  /// If the force depends on the velocity, adds -d force / d velocity [N s/m], which is symmetric and has the
  /// discretisation's pattern.
  virtual bool has_velocity_tangent(const Parameters&) const { return false; }
  virtual void add_velocity_tangent(const Motion&, const Parameters&, SparseMatrix&) const {}
  /// Returns the stored energy [J], if the effect has one.
  virtual double energy(const Motion&, const Parameters&) const { return 0.0; }

  /// Returns whether the two functions below do something.
  virtual bool observes() const { return false; }
  virtual void observe(const Parameters&, ObservedMotion&) const {}
  /// Returns the delay of the measurements' stamps [s].
  virtual double delay(const Parameters&) const { return 0.0; }
};

}  // namespace tissue_stiffness
