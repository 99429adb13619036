#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/finer_mesh.hpp"
#include "diagnosis/model_comparison.hpp"
#include "diagnosis/ranking.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"

namespace tissue_stiffness {

/// This is what an earlier round on this recording has found out.
struct PreviousRound {
  std::shared_ptr<const RecordingFit> finer = nullptr;      ///< the model on a finer mesh; null: none yet
  std::shared_ptr<const ModelComparison> models = nullptr;  ///< their noise is known; null: none yet
  Library library = {};                                     ///< see read_tangents
  bool beside_another = false;  ///< the model has an effect that was found: less of the search is repeated
  bool settled = false;         ///< the model keeps its fit, even where another would be better
  double rival = no_rival;      ///< what a known pair was `fitted` with: what is far behind it is not continued
};

/// A screening shows what a fitted model's error tells before anything is refitted: the library, ranked by its tangents,
/// and the mesh's part.
struct Screening {
  /// Reads the tangents of the `wanted` effects alone, if any.
  Screening(FittedModel& fitted, const DiagnosisOptions& options, PreviousRound previous = {},
            const std::vector<std::string>& wanted = {});

  /// Moves the base of these models to another fit, with what a finer mesh changes there. Tangents, and the base's
  /// assessment, stay those of the first place.
  void move_base(const BatchFit& fit, ModelComparison& models);

  /// Returns what a nonlinear effect has to explain before it is run in full [sigma^2]: a good part of the structured
  /// error, and enough to be believed.
  double least_gain() const;

  FittedModel& base;
  double cost;                         ///< sum of squared errors [sigma^2]
  const bool beside_another, settled;  ///< see PreviousRound
  const double rival;                  ///< likewise
  std::size_t effect_count = 0;        ///< number of effects that the library proposes, wanted or not
  std::vector<Candidate> candidates;   ///< their tangents are whitened
  Library library;                     ///< of models that the tangents were read from
  Eigen::VectorXd error;               ///< of the base, whitened
  Eigen::MatrixXd nuisance_tangents;   ///< of the base's parameters, and the directions of the mesh's error; whitened
  FinerMesh finer;
  double discretisation_error = 0.0;  ///< rms of what the base's parameters leave of the mesh's change [sigma]
  std::unique_ptr<Scorer> scorer;
  std::vector<Ranked> ranked;

  Explained explained;         ///< the base as it is compared
  ModelComparison comparison;  ///< of the base with others
  Assessment given;            ///< of the base
};

}  // namespace tissue_stiffness
