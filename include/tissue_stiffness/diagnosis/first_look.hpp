#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/diagnosis/finer_mesh.hpp"
#include "tissue_stiffness/diagnosis/model_comparison.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {

/// How far a look searches for what its base lacks: as far as all stages go, or, where the base has an effect that an
/// earlier look found, from tangents and the recording's beginning, or from tangents alone.
enum class SearchDepth { all, beginning, tangents };

/// What an earlier look at the same recording has found out.
struct Earlier {
  std::shared_ptr<const Study> finer = nullptr;             ///< the model on a finer mesh; null: none yet
  std::shared_ptr<const ModelComparison> models = nullptr;  ///< whose noise is known; null: none yet
  Library library = {};                                     ///< see find_candidates
  SearchDepth search = SearchDepth::all;
  bool settled = false;  ///< the model is not fitted anew, wherever it fits better
};

/// What a fitted model's error shows before anything is refitted: the library, ranked by its tangents, and the mesh's part.
struct FirstLook {
  FirstLook(Fitted& fitted, const DiagnosisOptions& options, Earlier earlier = {});

  /// Another fit takes the place of the base's. Tangents, and what the base was assessed as, stay
  /// those of the first place.
  void move_base(const BatchFit& fit);

  Fitted& base;
  double cost;               ///< sum of squared errors [sigma^2]
  const SearchDepth search;  ///< see Earlier, as the next one
  const bool settled;
  std::vector<Candidate> candidates;  ///< their tangents are whitened
  Library library;                    ///< that they were read from
  Eigen::VectorXd error;              ///< of the base, whitened
  Eigen::MatrixXd known;              ///< tangents of the base's parameters, and directions of the mesh's error; whitened
  FinerMesh finer;
  double floor = 0.0;  ///< rms of what the base's parameters leave of the mesh's change [sigma]
  std::unique_ptr<Scorer> scorer;
  std::vector<Ranked> ranked;

  Explained explained;         ///< the base as it is compared
  ModelComparison comparison;  ///< of the base with others
  Assessment given;            ///< of the base
};

}  // namespace tissue_stiffness
