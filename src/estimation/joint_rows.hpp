#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "estimation/input_posterior.hpp"
#include "estimation/misfit_test.hpp"
#include "estimation/shared_columns.hpp"

namespace tissue_stiffness {

/// The rows of several recordings of one body as functions of z = [w; eta], what all of them share and what each has for
/// itself.
class JointRows {
 public:
  /// One of the recordings.
  struct Part {
    const MeshError::Question& question;
    InputModels& models;
    InputLinearisation rows;
    bool predicted;  ///< it takes no part in the fit

    Part(const MeshError::Question& q, InputModels& m, bool p) : question(q), models(m), rows(q, m), predicted(p) {}
  };
  using Parts = std::vector<std::unique_ptr<Part>>;

  JointRows(Parts parts, const Sharing& sharing, const SharedParameters& parameters);

  std::size_t recordings() const { return parts_.size(); }
  Part& part(std::size_t recording) const { return *parts_[recording]; }
  const SharedParameters& parameters() const { return parameters_; }
  const SharedColumns& columns() const { return columns_; }
  /// Returns the parameters that the questions ask about, and the prior's standard deviations.
  Eigen::VectorXd asked() const;
  Eigen::VectorXd prior_std() const;
  /// Returns each nuisance's standard deviation, in units of its tolerance.
  Eigen::VectorXd nuisance_std() const;

  /// Returns the normal equations of one recording, in z of all.
  NormalEquations of(std::size_t recording, const Eigen::VectorXd& z, Constants constants) const;
  /// Returns those of each recording; of predicted ones they are empty.
  InputPosterior::Equations at(const Eigen::VectorXd& z, Constants constants) const;
  /// Tests a recording's residual at z, less what tolerated constants may leave of it. `fitted`: degrees of freedom that
  /// the fit took of it.
  MisfitTest test(std::size_t recording, const Eigen::VectorXd& z, double fitted,
                  const InputPosterior::Tolerated& tolerated) const;
  /// Returns the temperature of a recording's likelihood by that test. Structure that the residual may hide imitates what
  /// little tells the modulus. It counts as one error that all rows share (Miller & Dunson 2019).
  double temperature(std::size_t recording, const MisfitTest& test) const;

 private:
  Parts parts_;
  const SharedParameters& parameters_;
  SharedColumns columns_;
};

}  // namespace tissue_stiffness
