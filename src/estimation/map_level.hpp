#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimation/map_stiffness.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/patch_model.hpp"
#include "filter/posterior_linearization_filter.hpp"
#include "forward/reduced_model.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {

/// A level is one division of the body, fitted to a recording.
class MapLevel {
 public:
  /// Question and base have to outlive the level. It fits at once. `start` holds the free parameters of `base`;
  /// `log_modulus` takes the place of its modulus, one for each patch.
  MapLevel(const MapQuestion& question, const Model& base, std::vector<Patch> patches, const Eigen::VectorXd& start,
           const Eigen::VectorXd& log_modulus);

  const std::vector<Patch>& patches() const { return patches_; }
  /// These are the most probable log E of each patch, and the free parameters of the base model, with the patches' mean for
  /// its modulus.
  Eigen::VectorXd log_modulus() const;
  Eigen::VectorXd base_parameters() const;
  Eigen::Index size() const { return prior_mean_.size(); }  ///< number of free parameters
  double mean_square() const { return filter_->mean_square(); }
  /// Returns the log evidence of this level less that of `coarser`, both with the noise that this one leaves.
  double evidence_over(const MapLevel& coarser) const;

  /// The study tells what a finer mesh does to this fit; it is made once. `why_not` holds the reason where there is none.
  struct MeshStudy {
    std::optional<MeshError::Answer> answer;
    std::string why_not;
  };
  const MeshStudy& mesh_study();

  /// Returns the shift of the most probable parameters because of the mesh, estimate less truth, as far as the recording
  /// shows it. It is zero where that is not known.
  Eigen::VectorXd mesh_shift();

  /// Describes each patch with `shift` corrected and half of it in the interval. A patch is identified where its standard
  /// deviation is below half of the prior's.
  std::vector<StiffnessPatch> describe(const Eigen::VectorXd& shift) const;
  /// Tells for each patch whether the data alone would give log E, all else known, to half of the prior's standard
  /// deviation. A patch that nothing moves, or moves too little, is not seen.
  std::vector<bool> seen() const;

 private:
  void fit(const Eigen::VectorXd& start);
  double told() const;  ///< standard deviation of log E below which the data determine a patch
  double log_volume() const;
  double prior_cost() const;

  const MapQuestion& question_;
  std::vector<Patch> patches_;
  Eigen::Matrix3Xd centers_;
  PatchModel patch_model_;
  Model model_;
  std::vector<std::unique_ptr<ObservationOperator>> operators_;
  BasisOptions basis_;
  Eigen::VectorXd prior_mean_;
  Eigen::MatrixXd prior_covariance_;
  std::optional<PosteriorLinearizationFilter> filter_;
  std::optional<MeshStudy> study_;
};

}  // namespace tissue_stiffness
