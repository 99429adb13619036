#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "effects/load_error.hpp"
#include "estimation/agreement.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/misfit_test.hpp"
#include "estimation/shared_parameters.hpp"
#include "tissue_stiffness/types/estimate.hpp"

namespace tissue_stiffness {

/// The study tells what uncertain inputs do to the parameters. The errors of the measured loads and of the sensors' poses,
/// and what a finer mesh would change, are nuisance parameters eta. They are fitted with the model's parameters w to all
/// frames (Gauss-Newton) and marginalised. Declared constants are considered: they keep their values, and their tolerances
/// widen the covariance by what they do to the estimate (Schmidt 1966; Jazwinski 1970, sec. 8.4). A tolerance is only
/// stated, so an input's error has Student's distribution with 4 degrees of freedom and the tolerance as its scale. Its
/// variance, twice the scale's square, enters; a normal distribution of that variance has the same 95 % interval (2.78
/// scales). A nonlinear model runs its linear form, and nothing is fitted.
class InputStudy {
 public:
  explicit InputStudy(const Model& model);
  /// Studies several recordings of one body together. The models have to outlive this.
  InputStudy(const std::vector<const Model*>& models, Sharing sharing);
  ~InputStudy();
  InputStudy(const InputStudy&) = delete;
  InputStudy& operator=(const InputStudy&) = delete;

  using Question = MeshError::Question;

  /// A correction is the estimated error of one load, which is taken off its course.
  struct Correction {
    LoadErrorBasis basis;
    Eigen::VectorXd coefficients;
  };
  struct OfRecording {
    std::map<std::string, Correction> corrections;  ///< by topic
    MisfitTest test;
    double rows = 0.0;
    Eigen::MatrixXd information;  ///< of w, of the data alone and with every input exact
    Agreement agreement;          ///< with all other recordings
    Eigen::VectorXd mode;         ///< parameters of a prediction: those of the fit, and its own; empty: not predicted
  };
  struct Answer {
    Eigen::VectorXd asked;                 ///< parameters of the question
    Eigen::VectorXd w;                     ///< posterior mean with the nuisances marginalised, filter coordinates
    Eigen::VectorXd mode;                  ///< most probable parameters, with the corrections
    Eigen::MatrixXd from_noise;            ///< covariance of w if every input were exact
    Eigen::MatrixXd from_loads;            ///< what the loads' and poses' errors add to it
    Eigen::MatrixXd from_mesh;             ///< what the mesh's changes add to both
    Eigen::MatrixXd from_constants;        ///< what the constants' tolerances add
    std::vector<InputUncertainty> inputs;  ///< every considered error, for the reports
    std::string implausible;               ///< input that would have to be off by far more than its tolerance; empty: none
    bool fitted = false;                   ///< false: a model is nonlinear, and w is the question's
    std::vector<OfRecording> recordings;
  };
  /// Throws NumericalError when runs diverge.
  Answer study(const Question& question);
  /// Asks about every recording, each with its own part of w. A recording in `predicted` (one flag each) takes no part in
  /// the fit; its test and agreement tell how well the others foretell it.
  Answer study(const std::vector<const Question*>& questions, const std::vector<bool>& predicted);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tissue_stiffness
