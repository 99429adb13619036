#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "tissue_stiffness/settings/effect_entry.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// What an effect may look at when it proposes itself as missing.
struct ProposalContext {
  const ModelSettings& settings;  ///< of the model that may lack something
  const TetMesh& mesh;
  const std::map<std::string, Region>& regions;
  double young_modulus;              ///< where the estimate stands [Pa]
  double poisson_ratio;              ///< [-]
  double density;                    ///< [kg/m^3]
  double frame_interval;             ///< [s]
  double duration;                   ///< of the recording [s]
  std::vector<double> periods = {};  ///< rhythms to try [s]; empty: some that fit the recording

  bool holds(const std::string& effect) const;
  /// Effects of that name, in order.
  std::vector<const EffectSettings*> all(const std::string& effect) const;
  /// An effect of that name acts on that region.
  bool names(const std::string& effect, const std::string& region) const;
  /// Regions on which an effect `acting` acts and none of the name `absent`, in the order of the model.
  std::vector<std::string> regions_of(const std::string& acting, const std::string& absent) const;
  /// An effect of that name has that parameter estimated.
  bool estimates(const std::string& effect, const std::string& parameter) const;
  Eigen::Vector3d low() const { return mesh.nodes.rowwise().minCoeff(); }
  Eigen::Vector3d high() const { return mesh.nodes.rowwise().maxCoeff(); }
  double size() const { return (high() - low()).norm(); }
  bool observes(ObservationSettings::Kind kind) const;
};

/// A way in which the effect might be missing: an entry for the model file's list of effects.
struct Proposal {
  EffectEntry entry;      ///< the amplitude estimated about its absent value, a normal prior; the rest as given
  std::string amplitude;  ///< parameter that removes the effect at its absent value
  EffectEntry refine;     ///< the same with amplitude and scanned numbers estimated: where a refit starts
  /// The keys of a direction or a region that no refit leaves; empty where there is but one. An entry without such a key is
  /// of a kind, too: a foundation without a region is the one on the whole surface.
  std::vector<std::string> kind_keys = {};

  /// The arguments of those keys, as a model file has them; empty where there are none.
  std::string kind() const;
  /// The same but for the kind.
  bool is_other_kind_of(const Proposal& other) const;
};

/// The ways in which an effect might be missing; none where it makes no sense or is there already.
using Proposer = std::function<std::vector<Proposal>(const ProposalContext&)>;

}  // namespace tissue_stiffness
