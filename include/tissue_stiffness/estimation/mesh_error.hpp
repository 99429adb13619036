#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tissue_stiffness/effects/course.hpp"
#include "tissue_stiffness/estimation/relatives.hpp"
#include "tissue_stiffness/forward/model.hpp"
#include "tissue_stiffness/forward/reduced_basis.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// The same body with every tetrahedron cut into eight, and flat facets bent to the smooth surface that they stand for
/// unless the settings say that they are the body's own.
/// Nodes keep their numbers.
TetMesh finer(const TetMesh& mesh, const MeshSettings& settings);

/// Of a model on finer(mesh): the stiffness there needs no factor.
BasisOptions basis_beside(const TetMesh& mesh, const TetMesh& finer);

/// Covariance of what stays wrong (filter coordinates): of a linear model, which the shift corrects, half of it, 1 sigma,
/// and half of the moduli's rms shift for a modulus whose own happens to be small; of a nonlinear one, all of both.
Eigen::MatrixXd mesh_doubt(const Model& model, const Eigen::VectorXd& shift);

/// What the mesh does to the parameters. The model runs once more on a mesh with every tetrahedron cut into eight and flat
/// facets bent to the smooth surface they stand for; fitted to that run, the estimator's own mesh would be off by a shift.
/// Of a nonlinear model only what is linear in it runs: its shift is a measure of the doubt, no correction. `why_not` says
/// what stands against a study.
class MeshError {
 public:
  /// Empty when the study can be made: of such a mesh; of a model, whose file may ask not to.
  static std::string why_not(const TetMesh& mesh);
  static std::string why_not(const Model& model);

  /// Throws as Model does.
  explicit MeshError(const Model& model);
  /// For studies at theta alone, which the finer mesh's basis then needs to hold alone: half the work. With the coarse
  /// model's basis of that size.
  MeshError(const Model& model, const Eigen::VectorXd& theta, const BasisOptions& basis = {}, const Relatives& known = {});
  ~MeshError();
  MeshError(const MeshError&) = delete;
  MeshError& operator=(const MeshError&) = delete;

  /// What the study looks at: copies, so that it can run beside the estimator.
  struct Question {
    std::vector<Frame> frames;
    Eigen::VectorXd w;          ///< filter coordinates
    Eigen::VectorXd spread;     ///< of the sigma points around w
    Eigen::VectorXd prior_std;  ///< holds what the data do not determine
    double start = 0.0;         ///< [s]
    double first_stamp = 0.0;   ///< of the recording [s]
    std::map<std::string, Course> courses;
    /// What a finer mesh changes in the rows of each frame, see `changes`; empty: not known.
    std::vector<Eigen::VectorXd> mesh_changes;

    /// About a model that has its loads.
    Question(const Model& model, std::vector<Frame> seen, Eigen::VectorXd at, Eigen::VectorXd around,
             Eigen::VectorXd prior);
  };
  struct Answer {
    /// Estimate less truth in filter coordinates if the finer mesh were the truth: the fit of the coarse model to the fine
    /// run.
    Eigen::VectorXd shift;
    /// Mean square error over sigma that this fit leaves: with such a mesh a recording cannot be explained any better.
    double left = 0.0;
    /// The shift, as far as a recording shows it that is fitted with this mean square error over sigma: a mesh as wrong as
    /// that would leave a misfit; where there is less, the mesh is less wrong. (A body may really have the facets that the
    /// finer mesh bends.)
    Eigen::VectorXd believed(double mean_square) const;
  };
  /// Throws NumericalError when the fit does not settle.
  Answer study(const Question& question);
  /// For each frame, the rows that the finer mesh predicts at w less those of the model's own mesh at w + shift.
  std::vector<Eigen::VectorXd> changes(const Question& question, const Eigen::VectorXd& shift);

 private:
  struct Studies;
  std::unique_ptr<Studies> studies_;
};

}  // namespace tissue_stiffness
