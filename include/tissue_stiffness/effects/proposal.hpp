#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <string>
#include <vector>

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
  /// An effect of that name has that parameter estimated.
  bool estimates(const std::string& effect, const std::string& parameter) const;
  Eigen::Vector3d low() const { return mesh.nodes.rowwise().minCoeff(); }
  Eigen::Vector3d high() const { return mesh.nodes.rowwise().maxCoeff(); }
  double size() const { return (high() - low()).norm(); }
  bool observes(ObservationSettings::Kind kind) const;
};

/// A way in which the effect might be missing: an entry for the model file's list of effects.
struct Proposal {
  std::string yaml;       ///< the amplitude estimated about its absent value, {mean: ABSENT, std: SCALE}; the rest numbers
  std::string amplitude;  ///< parameter that removes the effect at its absent value
  std::string refine;     ///< the same with amplitude and scanned numbers estimated: where a refit starts
  std::string kind = {};  ///< direction or region, that no refit leaves; empty where there is but one

  /// The same but for the kind.
  bool is_other_kind_of(const Proposal& other) const;
};

/// The ways in which an effect might be missing; none where it makes no sense or is there already.
using Proposer = std::function<std::vector<Proposal>(const ProposalContext&)>;

/// A number as YAML, to six digits. A vector as [x, y, z].
std::string yaml(double value);
std::string yaml(const Eigen::Vector3d& value);
/// "{mean: m, std: s}" and "{prior: m, factor: f}".
std::string normal(double mean, double std);
std::string normal(const Eigen::Vector3d& mean, double std);
std::string log_normal(double median, double factor);

}  // namespace tissue_stiffness
