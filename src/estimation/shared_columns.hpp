#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "estimation/input_linearisation.hpp"
#include "estimation/shared_parameters.hpp"

namespace tissue_stiffness {

/// Maps z = [w; eta] of all recordings to that of each, z_j = A_j z. An error of one rig is one unknown for all of its
/// recordings, so it does not average out: a sensor's gain, delay and direction, the mesh, a constant. Noise is each
/// recording's own. An offset may last or change from one recording to the next, so it is the sum of a shared and an own
/// part with half of the variance each.
class SharedColumns {
 public:
  struct OfRecording {
    std::vector<InputGroup> inputs;
    Eigen::Index mesh_columns = 0;  ///< they are the last ones, and none of `inputs`
    std::vector<UncertainConstant> constants;
    int mesh = 0;  ///< recordings with the same number have the same mesh
  };
  SharedColumns(const Sharing& sharing, const SharedParameters& parameters, const std::vector<OfRecording>& recordings);

  Eigen::Index size() const { return size_; }
  Eigen::Index first_of_mesh() const { return first_of_mesh_; }
  const std::vector<InputGroup>& inputs() const { return inputs_; }  ///< with columns and tolerances of the shared z
  const std::vector<UncertainConstant>& constants() const { return constants_; }

  Eigen::VectorXd of(std::size_t recording, const Eigen::VectorXd& z) const { return maps_[recording] * z; }
  /// Returns a recording's own ones of all constants.
  Eigen::VectorXd constants_of(std::size_t recording, const Eigen::VectorXd& constants) const;
  /// Returns a recording's normal equations in the shared z.
  NormalEquations spread(std::size_t recording, const NormalEquations& own) const;

 private:
  using Entries = std::vector<Eigen::Triplet<double>>;
  Eigen::Index place(const std::string& key, InputGroup group);
  void add_inputs(const Sharing& sharing, std::size_t recording, const std::vector<InputGroup>& groups, Entries& entries);
  void add_constants(const std::vector<UncertainConstant>& constants);

  Eigen::Index size_ = 0, first_of_mesh_ = 0;
  std::vector<InputGroup> inputs_;
  std::vector<UncertainConstant> constants_;
  std::vector<std::vector<Eigen::Index>> constant_columns_;
  std::vector<Eigen::SparseMatrix<double>> maps_;
  std::map<std::string, Eigen::Index> places_;                ///< first column of each group, by what it is of
  std::map<std::pair<std::string, std::string>, int> loads_;  ///< number of each load, by topic and recording
};

}  // namespace tissue_stiffness
