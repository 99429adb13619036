#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/load_sample.hpp"
#include "tissue_stiffness/types/observation.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// What a model takes from arrays. The core believes its frames and loads, so each is checked here against the model. Every
/// member throws InputError, naming topic and stamp, for what does not fit.
class Inputs {
 public:
  Inputs(const ModelSettings& settings, const TetMesh& mesh, std::vector<LoadInput> loads);

  /// Returns what a sensor saw. Without a topic it is the model's only one. `ids` numbers the points of `vertices` and
  /// `markers`; without it they are all of them, in order.
  Observation observation(const pybind11::object& topic, double time, const pybind11::object& points,
                          const pybind11::object& ids) const;
  /// Returns a load: (1,) or a number [Pa]; force (3,) [N] with or without torque (6,) [N m]; a pose (4, 4) [m].
  LoadSample load(const std::string& topic, double time, const pybind11::object& value) const;
  /// Returns the frame of observations that this model, or one with the same sensors and mesh, has made.
  Frame frame(double time, std::vector<Observation> observations) const;

 private:
  int source(const pybind11::object& topic) const;
  void require_ids(const Observation& observation, const std::string& where) const;

  std::vector<ObservationSettings> sensors_;
  std::vector<LoadInput> loads_;
  int vertices_;
};

/// Returns the loads that the model's effects ask for.
std::vector<LoadInput> load_inputs(const ModelSettings& settings, const TetMesh& mesh);

}  // namespace tissue_stiffness
