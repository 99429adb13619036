#include <utility>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/inputs.hpp"
#include "python/model_file.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

std::string path(const py::object& file) {
  return py::str(py::module::import("os").attr("fspath")(file));
}

TetMesh mesh_of(const ModelFile& model) {
  const MeshSettings& mesh = model.settings.mesh;
  if (mesh.source == MeshSettings::Source::file) {
    const py::gil_scoped_release parallel;
    return build_mesh(mesh);
  }
  throw InputError(model.settings.name + ": mesh", "a mesh made of the first outline",
                   "a mesh file, or the mesh of a recording that has been read");
}

}  // namespace

void bind_model(py::module& module) {
  py::class_<ObservationSettings>(module, "ObservationSettings", "One entry of the model's list `observations`.")
      .def_property_readonly(
          "kind", [](const ObservationSettings& o) { return traits_of(o.kind).name; },
          "vertices, markers, points, contour, tracks or reaction")
      .def_readonly("topic", &ObservationSettings::topic)
      .def_readonly("noise", &ObservationSettings::noise, "1 sigma [m]; of a reaction [N]");
  py::class_<ModelFile>(module, "Model",
                        "A model file. Raises InputError for a key that is unknown, missing or out of range, and for a "
                        "file outside the model's folder unless `allow_outside` is true.")
      .def(py::init([](const py::object& file, bool allow_outside) { return read_model_file(path(file), allow_outside); }),
           py::arg("file"), py::arg("allow_outside") = false)
      .def_static(
          "from_text",
          [](const std::string& text, const py::object& directory, const std::string& name, bool allow_outside) {
            return parse_model(text, path(directory), name, allow_outside);
          },
          py::arg("text"), py::arg("directory") = ".", py::arg("name") = "model", py::arg("allow_outside") = false,
          "A model from YAML. Relative paths count from `directory`, and messages call the text `name`.")
      .def("with_effects", &with_effects, py::arg("entries"),
           "The model with further entries of its list `effects`, each given as YAML: 'viscous_damping: {beta: 0.01}'.")
      .def_property_readonly(
          "name", [](const ModelFile& m) { return m.settings.name; }, "The file, as messages call it.")
      .def_readonly("text", &ModelFile::text, "Content of the file.")
      .def_property_readonly("directory", [](const ModelFile& m) { return m.settings.directory; })
      .def_property_readonly(
          "effects",
          [](const ModelFile& m) {
            std::vector<std::string> labels;
            for (const EffectSettings& effect : m.settings.effects) labels.push_back(effect.label);
            return labels;
          },
          "Names of the effects; a repeated one gets #2, #3, ...")
      .def_property_readonly("observations", [](const ModelFile& m) { return m.settings.observations; })
      .def_property_readonly(
          "start", [](const ModelFile& m) { return m.settings.time.start; },
          "When the body was at rest, after the first stamp [s].")
      .def("__repr__", [](const ModelFile& m) { return "<Model " + m.settings.name + ">"; });
  module.def("build_mesh", &mesh_of, py::arg("model"), "The TetMesh of the model's mesh file.");
  module.def(
      "load_inputs",
      [](const ModelFile& model, const TetMesh& mesh) {
        const py::gil_scoped_release parallel;
        return load_inputs(model.settings, mesh);
      },
      py::arg("model"), py::arg("mesh"), "The loads that the model's effects ask for.");
  py::class_<Inputs>(module, "Inputs", "What a model takes from arrays; raises InputError for what does not fit.")
      .def(py::init([](const ModelFile& model, const TetMesh& mesh, std::vector<LoadInput> loads) {
             return Inputs(model.settings, mesh, std::move(loads));
           }),
           py::arg("model"), py::arg("mesh"), py::arg("loads"))
      .def("observation", &Inputs::observation, py::arg("topic"), py::arg("stamp"), py::arg("points"), py::arg("ids"))
      .def("load", &Inputs::load, py::arg("topic"), py::arg("stamp"), py::arg("value"))
      .def("frame", &Inputs::frame, py::arg("stamp"), py::arg("observations"));
  py::class_<Frame>(module, "Frame", "All observations of one instant, checked against a model.")
      .def_readonly("time", &Frame::time, "[s] on the recording's clock")
      .def_readonly("observations", &Frame::observations);
}

}  // namespace tissue_stiffness
