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
  /// 1 sigma by which a declared number may be off where the model file says nothing of it; of a share: of its size.
  double tolerance = 0.0, tolerance_share = 0.0;
};

/// What an effect is, in words and numbers.
struct EffectSpec {
  std::string name;
  std::string summary;
  std::string formula;
  std::string source;
  std::vector<ParameterSpec> parameters;
  std::vector<std::pair<std::string, std::string>> keys;  ///< further keys and what they take
  Proposer proposals = nullptr;                           ///< null: its absence is nothing to look for
  bool of_simulation = false;                             ///< no physics, but what a simulated recording has of its making
};

/// What an effect may look at while it is built.
struct EffectContext {
  const TetMesh& mesh;
  const Discretisation& fem;
  const std::map<std::string, Region>& regions;
  const ModelSettings& settings;         ///< the whole model file
  std::vector<std::vector<int>> solids;  ///< tetrahedra of each elasticity, in order
  double young_modulus;                  ///< prior median [Pa], a scale for penalties
  CourseTable& courses;                  ///< time courses by topic
  std::vector<LoadInput>& inputs;

  /// Throws InputError naming the key and the regions there are.
  const Region& region(const Value& name) const;
};

/// Instant at which a nonlinear effect is evaluated.
struct Motion {
  double time;
  const Eigen::VectorXd& displacement;  ///< 3n [m]
  const Eigen::VectorXd& velocity;      ///< 3n [m/s]
  double finite_share = 0.0;            ///< of finite strain, 0 to 1
  double load_factor = 1.0;             ///< of every measured load
  double since = 0.0;                   ///< the recording's first stamp [s]
};

/// What a sensor makes of the motion. Effects of the observation change it in place, in the order of the model file.
struct ObservedMotion {
  const TetMesh& mesh;
  double time;                   ///< since the model's start [s]
  Eigen::VectorXd displacement;  ///< apparent, 3n [m]
  double outward = 0.0;          ///< of outlines and surface points, along their outward normal [m]
};

/// One physical effect of the model. Hooks are const and default to nothing.
class Effect {
 public:
  virtual ~Effect() = default;

  /// It follows from its own entry, the mesh and its regions alone, and nothing changes it: models of one body may share
  /// it.
  virtual bool shareable() const { return false; }

  virtual void linear_terms(LinearTerms&) const {}
  /// Its parameters are followed by those of the model's elasticities.
  virtual bool needs_elasticity() const { return false; }
  /// Nodes held at rest, and nodes of other effects that it lets go while releases() holds.
  virtual std::vector<int> fixed_nodes() const { return {}; }
  virtual std::vector<int> released_nodes() const { return {}; }
  virtual bool releases(const Parameters&) const { return false; }

  /// True when the two below replace the linear stiffness and loads under finite strain.
  virtual bool has_finite_form() const { return false; }
  /// Elasticity only: its law asks for finite strain.
  virtual bool always_finite() const { return false; }
  virtual void add_finite_force(const Motion&, const Parameters&, Eigen::VectorXd&) const {}
  virtual void add_finite_stiffness(const Motion&, const Parameters&, SparseMatrix&) const {}

  /// True when the force below is not zero: the model is then integrated in full.
  virtual bool nonlinear() const { return false; }
  /// Adds the force [N] (external minus internal) that is no linear term.
  virtual void add_force(const Motion&, const Parameters&, Eigen::VectorXd&) const {}
  /// Adds -d force / d displacement [N/m]; symmetric, pattern of the discretisation.
  virtual void add_stiffness(const Motion&, const Parameters&, SparseMatrix&) const {}
  /// The force depends on the velocity: then adds -d force / d velocity [N s/m], symmetric, the same pattern.
  virtual bool rubs(const Parameters&) const { return false; }
  virtual void add_friction(const Motion&, const Parameters&, SparseMatrix&) const {}
  /// Stored energy [J], where the effect has one.
  virtual double energy(const Motion&, const Parameters&) const { return 0.0; }

  /// True when the two below do something.
  virtual bool observes() const { return false; }
  virtual void observe(const Parameters&, ObservedMotion&) const {}
  /// How late measurements are stamped [s].
  virtual double delay(const Parameters&) const { return 0.0; }
};

}  // namespace tissue_stiffness
