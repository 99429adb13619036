#pragma once

#include <pybind11/pybind11.h>

namespace tissue_stiffness {

// Each adds its part to the module `_core`.
void bind_types(pybind11::module& module);
void bind_model(pybind11::module& module);
void bind_estimator(pybind11::module& module);
void bind_diagnosis(pybind11::module& module);

}  // namespace tissue_stiffness
