#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {

/// A model, its fit to the training frames, and the free run there.
struct Fitted {
  ModelSettings settings;
  std::unique_ptr<Study> study;
  BatchFit fit;
  Study::Rows rows;
};

/// What one look at a fitted model finds missing.
struct Finding {
  std::string verdict;  ///< adequate, missing, numerics or unexplained
  std::vector<std::string> set;
  std::vector<MissingEffect> effects;  ///< best first
  std::vector<Refit> refits;           ///< best first
  double floor = 0.0;                  ///< rms of what a finer mesh would change [sigma]
};

/// Ranks the library by tangents, refits the best (or `wanted` ones, if any), and the best pairs where no single effect
/// explains the error. Throws InputError for a wanted effect that nothing proposes.
Finding look(const Fitted& base, const std::vector<std::string>& wanted, const DiagnosisOptions& options);

/// Held-out frames agree that the refit is better than the base.
bool proven(const Fitted& base, const Refit& refit);

/// What a mesh of eight times as many elements with a smooth boundary would change in the rows at w [sigma]: the error that
/// is the mesh's own, to first order. Zero where that cannot be found out or the model file does not want it.
Eigen::VectorXd mesh_residual(const Study& base, const Eigen::VectorXd& w, const Study::Rows& rows);

}  // namespace tissue_stiffness
