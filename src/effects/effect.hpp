#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "effects/course.hpp"
#include "effects/proposal.hpp"
#include "effects/terms.hpp"
#include "fem/discretisation.hpp"
#include "fem/neo_hookean.hpp"
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
  std::optional<LoadInput::Kind> load = std::nullopt;     ///< what its key `topic` carries; empty: it has none
  Proposer proposals = nullptr;                           ///< null: its absence is not searched for
  bool of_simulation = false;                             ///< not physics, but a property of simulated recordings
  bool of_recording = false;                              ///< differs between recordings of one body
  bool of_finite_strain = false;                          ///< a law that has no meaning at small strain
  bool contact = false;                                   ///< keeps bodies apart; its stiffness is a penalty
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

/// A force on the body that is not a linear term. A model with one is integrated in full.
class NonlinearForce {
 public:
  /// Adds the force [N] (external minus internal).
  virtual void add_force(const Motion&, const Parameters&, Eigen::VectorXd&) const = 0;
  /// Adds -d force / d displacement [N/m], which is symmetric and has the pattern of the discretisation.
  virtual void add_stiffness(const Motion&, const Parameters&, SparseMatrix&) const = 0;
  /// If the force depends on the velocity, adds -d force / d velocity [N s/m], which is symmetric and has the
  /// discretisation's pattern.
  virtual bool has_velocity_tangent(const Parameters&) const { return false; }
  virtual void add_velocity_tangent(const Motion&, const Parameters&, SparseMatrix&) const {}
  /// Returns the region at which a sensor may measure this force, its reaction; empty: none does.
  virtual std::string reacting_region() const { return ""; }

 protected:
  ~NonlinearForce() = default;
};

/// Contact of the surface with something rigid. Its force acts at single points of boundary facets, and depends on the
/// motion of these points alone.
class Contact {
 public:
  /// A point that touches.
  struct Touch {
    Eigen::Matrix<int, Eigen::Dynamic, 1, 0, 6, 1> nodes;     ///< of its facet
    Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 6, 1> shape;  ///< their shape functions at the point
    Eigen::Vector3d force;                                    ///< on the body [N]
    Eigen::Matrix3d stiffness;                                ///< -d force / d displacement of the point [N/m]
    Eigen::Matrix3d damping;                                  ///< -d force / d velocity of the point [N s/m]
  };
  /// Returns the nodes of all facets that may touch, ascending.
  virtual const std::vector<int>& nodes() const = 0;
  /// Appends the points that touch. Reads the motion of nodes() only.
  virtual void find(const Motion&, const Parameters&, std::vector<Touch>&) const = 0;
  /// Returns how far the obstacle goes from one time to another, over its size. It is infinite where the obstacle is not
  /// there yet, and with friction, because that depends on the velocity in between.
  virtual double travel(double from, double to, const Parameters&) const = 0;

 protected:
  ~Contact() = default;
};

/// A law whose stress follows from the deformation gradient F at the same place alone. Reduced models then need its stress
/// at few quadrature points.
class PointForm {
 public:
  /// Adds the first Piola-Kirchhoff stress P(F) [Pa] at quadrature point q of element e, and its derivative. Both throw
  /// NumericalError where the law has no stress.
  virtual void add_stress(int e, int q, const Eigen::Matrix3d& f, const Parameters&, Eigen::Matrix3d& stress) const = 0;
  virtual void add_tangent(int e, int q, const Eigen::Matrix3d& f, const Parameters&, StressTangent& tangent) const = 0;
  /// Returns the moduli at rest of a law that has_strain_form() [Pa].
  virtual Lame rest_moduli(int /*e*/, int /*q*/, const Parameters&) const { return {0.0, 0.0}; }

 protected:
  ~PointForm() = default;
};

/// A load whose force is size(time) times a polynomial of second degree in the displacement, as that of a pressure that
/// follows the surface.
class FollowerLoad {
 public:
  /// Returns the size, with the factor of every measured load.
  virtual double size(double time, double load_factor, const Parameters&) const = 0;
  /// Adds the force of a unit size at the displacement u (3n).
  virtual void add_unit_force(const Eigen::VectorXd& u, Eigen::VectorXd& force) const = 0;

 protected:
  ~FollowerLoad() = default;
};

/// What replaces an effect's linear stiffness and loads under finite strain.
class FiniteStrainForm {
 public:
  virtual void add_finite_force(const Motion&, const Parameters&, Eigen::VectorXd&) const = 0;
  virtual void add_finite_stiffness(const Motion&, const Parameters&, SparseMatrix&) const = 0;
  /// Only for elasticity: returns whether its law requires finite strain.
  virtual bool always_finite() const { return false; }

  /// A law whose stiffness at rest is that of moduli has a stress linear in a strain, which turns with the body. Damping
  /// and relaxing branches act through it, because a linear stiffness would resist a body that turns. These add `scale`
  /// times its force [N] at the displacement u, for strains given at all quadrature points (see green_strains), and its
  /// tangent for strains sym(F^T grad w).
  virtual bool has_strain_form() const { return false; }
  virtual void add_strain_force(const Eigen::VectorXd& /*u*/, const Eigen::Ref<const Eigen::VectorXd>& /*strains*/,
                                const Parameters&, double /*scale*/, Eigen::VectorXd&) const {}
  virtual void add_strain_tangent(const Eigen::VectorXd& /*u*/, const Parameters&, double /*scale*/, SparseMatrix&) const {}

  /// Returns the same force point by point, or as that of a load; null: it has no such form. Models with a form that has
  /// neither are never reduced.
  virtual const PointForm* point_form() const { return nullptr; }
  virtual const FollowerLoad* follower_load() const { return nullptr; }

 protected:
  ~FiniteStrainForm() = default;
};

/// What an effect does to the nodes that are held at rest.
class Support {
 public:
  virtual std::vector<int> fixed_nodes() const { return {}; }
  /// Returns nodes that other effects hold, and that this one releases while is_compliant() is true.
  virtual std::vector<int> compliant_nodes() const { return {}; }
  virtual bool is_compliant(const Parameters&) const { return false; }

 protected:
  ~Support() = default;
};

/// What an effect does to the measurements.
class SensorModel {
 public:
  virtual void observe(const Parameters&, ObservedMotion&) const {}
  /// Returns the delay of the measurements' stamps [s].
  virtual double delay(const Parameters&) const { return 0.0; }

 protected:
  ~SensorModel() = default;
};

/// One physical effect of the model. It has linear terms, and an interface for whatever else it does; null: nothing. All
/// functions are const.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Returns whether the effect depends only on its own entry, the mesh and its regions, and never changes. Then models of
  /// one body may share it.
  virtual bool shareable() const { return false; }
  /// Returns whether the parameters of the model's elasticities follow the effect's own.
  virtual bool needs_elasticity() const { return false; }

  virtual void linear_terms(LinearTerms&) const {}
  virtual const NonlinearForce* nonlinear_force() const { return nullptr; }
  virtual const Contact* contact() const { return nullptr; }
  virtual const FiniteStrainForm* finite_strain() const { return nullptr; }
  virtual const Support* support() const { return nullptr; }
  virtual const SensorModel* sensor_model() const { return nullptr; }
  /// Returns the stored energy [J], if the effect has one.
  virtual double energy(const Motion&, const Parameters&) const { return 0.0; }
};

}  // namespace tissue_stiffness
