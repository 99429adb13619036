// The module `tissue_stiffness._core`: the public headers in Python, without ROS.
#include "python/bindings.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "vtu/vtu_reader.hpp"

namespace py = pybind11;

PYBIND11_MODULE(_core, module) {
  using namespace tissue_stiffness;
  module.doc() = "The C++ library behind tissue_stiffness.";
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError).attr("__doc__") =
      "An input is wrong: a file, a key, a topic or an array. The text says where, what was found and what is allowed.";
  py::register_exception<NumericalError>(module, "NumericalError", PyExc_ArithmeticError).attr("__doc__") =
      "A computation could not be finished, as with a diverging step.";
  for (const char* error : {"InputError", "NumericalError"}) module.attr(error).attr("__module__") = "tissue_stiffness";
  accept_vtu_meshes();
  bind_types(module);
  bind_model(module);
  bind_estimator(module);
  bind_diagnosis(module);
}
