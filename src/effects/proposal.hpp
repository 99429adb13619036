#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "settings/effect_entry.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// What is available to an effect when it proposes itself as missing.
struct ProposalContext {
  const ModelSettings& settings;  ///< settings of the model that may lack an effect
  const TetMesh& mesh;
  const std::map<std::string, Region>& regions;
  double young_modulus;              ///< present estimate [Pa]
  double poisson_ratio;              ///< [-]
  double density;                    ///< [kg/m^3]
  double frame_interval;             ///< [s]
  double duration;                   ///< of the recording [s]
  std::vector<double> periods = {};  ///< periods to try [s]; empty: some that fit the recording

  bool holds(const std::string& effect) const;
  /// Returns the effects of this name, in order.
  std::vector<const EffectSettings*> all(const std::string& effect) const;
  /// Returns whether an effect of this name acts on this region.
  bool names(const std::string& effect, const std::string& region) const;
  /// Returns the regions on which an effect `acting` acts but no effect `absent`, in the order of the model.
  std::vector<std::string> regions_of(const std::string& acting, const std::string& absent) const;
  /// Returns whether an effect of this name has this parameter estimated.
  bool estimates(const std::string& effect, const std::string& parameter) const;
  /// Returns whether an elasticity has a law of finite strain.
  bool finite_strain() const;
  /// These return the corners of the body's bounding box [m], and its diagonal.
  Eigen::Vector3d low() const;
  Eigen::Vector3d high() const;
  double size() const;
  bool observes(ObservationSettings::Kind kind) const;
};

/// A variant in which the effect might be missing: an entry for the model file's list of effects.
struct Proposal {
  EffectEntry entry;      ///< the amplitude has a normal prior about its absent value; the rest is given
  std::string amplitude;  ///< parameter that removes the effect at its absent value
  EffectEntry refine;     ///< start of a refit: amplitude and scanned numbers are estimated
  /// The keys of a direction or a region, which a refit does not change; empty where there is only one. An entry without
  /// such a key is a kind, too: a foundation without a region is the one on the whole surface.
  std::vector<std::string> kind_keys = {};
  /// The keys of a place or a direction that a refit estimates, and at each value of which a stiffness is projected anew.
  std::vector<std::string> shape_keys = {};

  /// Returns the arguments of these keys as in a model file; empty where there are none.
  std::string kind() const;
  /// Returns the keys of the refit's arguments: a mass on a region has another form than one at a place that is fitted.
  std::string form() const;
  /// Returns the refit's entry with place and direction as proposed, for fits that only rank.
  EffectEntry with_given_shape() const;
  /// Returns whether fits that only rank differ in nothing but where their estimated numbers start.
  bool differs_in_start_from(const Proposal& other) const;
  /// Returns whether the proposals differ only in their kind.
  bool is_other_kind_of(const Proposal& other) const;
};

/// Proposes the variants in which an effect might be missing. There are none where it makes no sense or already exists.
using Proposer = std::function<std::vector<Proposal>(const ProposalContext&)>;

}  // namespace tissue_stiffness
