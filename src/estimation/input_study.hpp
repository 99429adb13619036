#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "effects/load_error.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/misfit_test.hpp"
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
  ~InputStudy();
  InputStudy(const InputStudy&) = delete;
  InputStudy& operator=(const InputStudy&) = delete;

  using Question = MeshError::Question;

  /// A correction is the estimated error of one load, which is taken off its course.
  struct Correction {
    LoadErrorBasis basis;
    Eigen::VectorXd coefficients;
  };
  struct Answer {
    Eigen::VectorXd asked;                          ///< parameters of the question
    Eigen::VectorXd w;                              ///< posterior mean with the nuisances marginalised, filter coordinates
    Eigen::VectorXd mode;                           ///< most probable parameters, with the corrections
    Eigen::MatrixXd from_noise;                     ///< covariance of w if every input were exact
    Eigen::MatrixXd from_loads;                     ///< what the loads' and poses' errors add to it
    Eigen::MatrixXd from_mesh;                      ///< what the mesh's changes add to both
    Eigen::MatrixXd from_constants;                 ///< what the constants' tolerances add
    std::map<std::string, Correction> corrections;  ///< by topic
    std::vector<InputUncertainty> inputs;           ///< every considered error, for the reports
    MisfitTest test;
    std::string implausible;  ///< input that would have to be off by far more than its tolerance; empty: none
    double rows = 0.0;
    bool fitted = false;  ///< false: the model is nonlinear, and w is the question's
  };
  /// Throws NumericalError when runs diverge.
  Answer study(const Question& question);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace tissue_stiffness
