#pragma once

#include <Eigen/Core>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "effects/course.hpp"
#include "estimation/reuse_sources.hpp"
#include "forward/model.hpp"
#include "forward/reduced_basis.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Returns the body's mesh with every tetrahedron cut into eight. Flat facets are bent to the smooth surface that they
/// stand for, unless the settings say that they are the body's own. Nodes keep their numbers.
TetMesh refined_mesh(const TetMesh& mesh, const MeshSettings& settings);

/// Returns the basis options of a model on `finer`, which is refined_mesh(mesh): the stiffness there needs no factor.
BasisOptions basis_beside(const TetMesh& mesh, const TetMesh& finer);

/// Returns the covariance of what stays wrong (filter coordinates). A model that is studied in full is corrected by the
/// shift, so half of it stays, 1 sigma. A modulus whose own shift happens to be small gets half of the moduli's rms shift.
/// A model that is studied in its linear form keeps all of both.
Eigen::MatrixXd mesh_discrepancy(const Model& model, const Eigen::VectorXd& shift);
Eigen::MatrixXd mesh_discrepancy(const std::vector<FreeParameter>& free, bool of_linear_form, const Eigen::VectorXd& shift);

/// The study tells what the mesh does to the parameters. The model runs once more on a mesh with every tetrahedron cut into
/// eight and flat facets bent to the smooth surface they stand for. Fitted to that run, the estimator's own mesh would be
/// off by a shift. A model that is not studied in full (see studied_in_full) runs only what is linear in it; its shift
/// measures the discrepancy and corrects nothing. `why_not` says what stands against a study.
class MeshError {
 public:
  /// Returns why no study can be made on such a mesh, or of a model, whose file may forbid it; empty: one can.
  static std::string why_not(const TetMesh& mesh);
  static std::string why_not(const Model& model);

  /// Throws as Model does.
  explicit MeshError(const Model& model);
  /// Prepares studies at theta alone, with `basis` for the coarse model. The finer mesh's basis then holds theta only,
  /// which halves the work.
  MeshError(const Model& model, const Eigen::VectorXd& theta, const BasisOptions& basis = {},
            const ReuseSources& known = {});
  ~MeshError();
  MeshError(const MeshError&) = delete;
  MeshError& operator=(const MeshError&) = delete;

  /// The question holds what the study needs: copies, so that it can run in the background.
  struct Question {
    std::vector<Frame> frames;
    Eigen::VectorXd w;          ///< filter coordinates
    Eigen::VectorXd spread;     ///< of the sigma points around w
    Eigen::VectorXd prior_std;  ///< holds what the data do not determine
    double start = 0.0;         ///< [s]
    double first_stamp = 0.0;   ///< of the recording [s]
    std::map<std::string, Course> courses;
    /// What a finer mesh changes in the rows of each frame (see `changes`); empty: not known.
    std::vector<Eigen::VectorXd> mesh_changes;
    std::function<void()> checkpoint = [] {};  ///< called before every frame of a run; what it throws ends the study

    /// Asks about a model that has its loads.
    Question(const Model& model, std::vector<Frame> seen, Eigen::VectorXd at, Eigen::VectorXd around,
             Eigen::VectorXd prior);
    /// Gives its loads to a model.
    void drive(Model& model) const;
  };
  struct Answer {
    /// If the finer mesh were the truth, this is estimate less truth in filter coordinates: the fit of the coarse model to
    /// the fine run.
    Eigen::VectorXd shift;
    /// This fit leaves this mean square error over sigma: with such a mesh a recording cannot be explained any better.
    double left = 0.0;
    /// Returns the shift as far as a recording shows it. That recording is fitted with this mean square error over sigma. A
    /// mesh as wrong as the shift says would leave a misfit; where there is less, the mesh is less wrong. (A body may
    /// really have the facets that the finer mesh bends.)
    Eigen::VectorXd believed(double mean_square) const;
  };
  /// Throws NumericalError when the fit does not settle.
  Answer study(const Question& question);
  /// Returns for each frame the rows that the finer mesh predicts at w less those of the model's own mesh at w + shift.
  std::vector<Eigen::VectorXd> changes(const Question& question, const Eigen::VectorXd& shift);

 private:
  struct Studies;
  std::unique_ptr<Studies> studies_;
};

}  // namespace tissue_stiffness
