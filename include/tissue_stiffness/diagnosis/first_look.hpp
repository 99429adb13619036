#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/diagnosis/finer_mesh.hpp"
#include "tissue_stiffness/diagnosis/ranking.hpp"

namespace tissue_stiffness {

/// rms over what has to be left, of a fit that need not be bettered.
constexpr double kExplained = 1.02;

/// Mean square [sigma^2] of noise, and of what the mesh itself does, whose rms is `floor` [sigma].
constexpr double unavoidable_mean_square(double floor) {
  return 1.0 + floor * floor;
}

/// What a fitted model's error shows before anything is refitted: the library, ranked by its tangents, and the mesh's part.
struct FirstLook {
  /// `earlier`: what an earlier look at the same recording found of a finer mesh; its change is found out now where it is
  /// empty or zero, or makes the error much larger. `library`: see find_candidates.
  FirstLook(const Fitted& fitted, const DiagnosisOptions& options, FinerMesh earlier, Library library = {});

  const Fitted& base;
  const double rows, cost;  ///< number, and sum of squared errors [sigma^2]
  const bool first;         ///< no earlier look at the same recording
  std::vector<Candidate> candidates;
  Library library;                 ///< that they were read from
  Eigen::MatrixXd known;           ///< tangents of the base's parameters
  FinerMesh finer;                 ///< its change is zero where that makes the error much larger
  double by_mesh = 0.0;            ///< of the sum of squared errors
  double floor = 0.0;              ///< rms of what the base's parameters leave of the mesh's change [sigma]
  std::unique_ptr<Scorer> scorer;  ///< of the error that the mesh does not explain
  std::vector<Ranked> ranked;

  double structured() const;   ///< sum of squares beyond noise
  double unavoidable() const;  ///< sum of squares that is no more than noise and what the mesh itself does
  bool noise() const;          ///< the error may be noise
  bool numerics() const;       ///< a finer mesh explains it
  bool explained_by(const Refit& refit) const;
};

constexpr double kRemainder = 1.0 / 3.0;  // of a finer mesh's change: what it leaves of the error at second order

}  // namespace tissue_stiffness
