#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {

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

/// The same model on a mesh of eight times as many elements with a smooth boundary, fitted to the same frames.
struct FinerMesh {
  Eigen::VectorXd change;  ///< of the rows [sigma]: the error that is the mesh's own; zero where it cannot be found out
  double explained = 0.0;  ///< how much smaller the sum of squared errors is [sigma^2]
};
/// Nothing where the model is nonlinear or large, or the model file does not want it.
FinerMesh finer_mesh(const Fitted& base);

}  // namespace tissue_stiffness
