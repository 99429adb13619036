// The module `tissue_stiffness._bag`: rosbags as frames. It alone needs ROS's libraries, so it is loaded for a bag only.
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "python/arrays.hpp"
#include "python/model_file.hpp"
#include "tools/recording_reader.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_bag, module) {
  using namespace tissue_stiffness;
  py::module::import("tissue_stiffness._core");  // which has the types of what is read
  py::class_<Instant>(module, "Instant", "What was measured at one instant.")
      .def_property_readonly(
          "stamp", [](const Instant& i) { return i.frame.time; }, "[s]")
      .def_property_readonly("observations", [](const Instant& i) { return i.frame.observations; })
      .def_readonly("loads", &Instant::loads, "Loads since the instant before, up to this one and a little later.")
      .def_readonly("reason", &Instant::reason, "Why nothing, or not everything, could be used.");
  py::class_<RecordingReader>(module, "Reader", "Reads a rosbag for a model, instant by instant.")
      .def(py::init([](const ModelFile& model, const std::string& file) {
             const py::gil_scoped_release parallel;
             return std::make_unique<RecordingReader>(file, model.settings);
           }),
           py::arg("model"), py::arg("file"))
      .def("next", &RecordingReader::next, py::call_guard<py::gil_scoped_release>(), "The next Instant; None at the end.")
      .def_property_readonly("mesh", &RecordingReader::mesh)
      .def_property_readonly(
          "first_stamp", [](const RecordingReader& r) { return r.reader().first_stamp(); }, "[s]");
}
