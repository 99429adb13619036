#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "forward/model.hpp"
#include "report/read_results.hpp"
#include "tools/model_option.hpp"

namespace tissue_stiffness {

/// The model that `estimate` found, with the loads of its recording.
struct EstimatedModel {
  SavedResults results;
  std::unique_ptr<Model> model;
  Eigen::VectorXd theta;
  std::vector<double> load_times;    ///< of all samples of its loads, on the recording's clock [s]
  Eigen::VectorXd mapped_modulus;    ///< of each tetrahedron, NaN where none is mapped [Pa]; empty: there is no map
  double common_modulus = 1.0;       ///< that the map replaces [Pa]
  std::vector<std::string> remarks;  ///< sentences on why the estimate must not be relied on
};

/// Rebuilds the model from a results.json or its folder. `model` and `recording` say where these files are now; empty:
/// where the results say. The recording is read for measured loads, and for a mesh that comes from an outline. Throws
/// InputError for what is missing or does not fit.
EstimatedModel load_estimated_model(const std::string& results, const ModelOption& model = {},
                                    const std::string& recording = "");

}  // namespace tissue_stiffness
