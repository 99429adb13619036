#include <utility>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

std::string names(const Estimate& estimate) {
  std::string all;
  for (const ParameterEstimate& p : estimate.parameters) all += (all.empty() ? "" : ", ") + p.name;
  return all.empty() ? "none, because nothing is estimated" : all;
}

const ParameterEstimate& parameter(const Estimate& estimate, const std::string& name) {
  for (const ParameterEstimate& p : estimate.parameters) {
    if (p.name == name) return p;
  }
  throw InputError("parameter", name, names(estimate));
}

/// Returns the only Young's modulus. Where there are several, none of them stands for the body.
const ParameterEstimate& modulus(const Estimate& estimate) {
  const ParameterEstimate* found = nullptr;
  for (const ParameterEstimate& p : estimate.parameters) {
    if (!is_young_modulus(p.name)) continue;
    if (found != nullptr)
      throw InputError("young_modulus", "several moduli", "the name of a parameter: " + names(estimate));
    found = &p;
  }
  if (found == nullptr) throw InputError("young_modulus", "no modulus", "the name of a parameter: " + names(estimate));
  return *found;
}

std::pair<double, double> interval(const Estimate& estimate) {
  const ParameterEstimate& p = modulus(estimate);
  return {p.lower95, p.upper95};
}

std::string shown(const ParameterEstimate& p) {
  return py::str("{} = {:.5g} {} ({:.5g} to {:.5g})").format(p.name, p.mean, p.unit, p.lower95, p.upper95);
}

std::string shown(const Estimate& estimate) {
  std::string text = "<Estimate " + to_string(estimate.state);
  for (const ParameterEstimate& p : estimate.parameters) text += ", " + shown(p);
  return text + ">";
}

void bind_estimate(py::module& module) {
  py::class_<ParameterEstimate>(module, "ParameterEstimate", "One estimated quantity in its own unit.")
      .def(py::init<std::string, std::string, double, double, double, double>(), py::arg("name"), py::arg("unit"),
           py::arg("mean"), py::arg("std"), py::arg("lower95"), py::arg("upper95"))
      .def_readonly("name", &ParameterEstimate::name, "effect.parameter; a repeated effect's name gets #2, #3, ...")
      .def_readonly("unit", &ParameterEstimate::unit)
      .def_readonly("mean", &ParameterEstimate::mean)
      .def_readonly("std", &ParameterEstimate::std)
      .def_readonly("lower95", &ParameterEstimate::lower95, "Lower end of the 95 % interval.")
      .def_readonly("upper95", &ParameterEstimate::upper95, "Upper end of the 95 % interval.")
      .def("__repr__", [](const ParameterEstimate& p) { return "<" + shown(p) + ">"; });
  py::class_<Estimate>(module, "Estimate", "Posterior distribution after a frame.")
      .def_readonly("time", &Estimate::time, "[s] on the recording's clock")
      .def_property_readonly(
          "state", [](const Estimate& e) { return to_string(e.state); },
          "no_data, converging, converged, doubtful, drifting, stale or model_invalid")
      .def_readonly("state_reason", &Estimate::state_reason, "Reason for the state, as a sentence.")
      .def_readonly("parameters", &Estimate::parameters, "A ParameterEstimate for each unknown.")
      .def_readonly("covariance", &Estimate::covariance, "(p, p), in the parameters' own units")
      .def_property_readonly(
          "young_modulus", [](const Estimate& e) { return modulus(e).mean; },
          "Mean of the only Young's modulus [Pa]. Raises InputError unless there is exactly one.")
      .def_property_readonly("interval", &interval, "95 % interval of the only Young's modulus [Pa].")
      .def("__getitem__", &parameter, py::arg("name"), "The ParameterEstimate of this name.")
      .def("__repr__", py::overload_cast<const Estimate&>(&shown));
  py::class_<Identifiability>(module, "Identifiability", "Whether the data determine a parameter, and why.")
      .def(py::init<std::string, std::string>(), py::arg("verdict"), py::arg("reason"))
      .def_readonly("verdict", &Identifiability::verdict, "absolute, ratio_only or none")
      .def_readonly("reason", &Identifiability::reason)
      .def("__repr__", [](const Identifiability& i) { return "<" + i.verdict + ": " + i.reason + ">"; });
}

void bind_step(py::module& module) {
  py::class_<Misfit>(module, "Misfit", "Difference between measurement and model in one frame, at the estimate.")
      .def_readonly("time", &Misfit::time, "[s]")
      .def_readonly("count", &Misfit::count, "Number of rows that were compared.")
      .def_readonly("lengths", &Misfit::lengths, "Those of them that are lengths, and no forces.")
      .def_readonly("outliers", &Misfit::outliers, "Number of rows whose weight is below one half.")
      .def_readonly("rms", &Misfit::rms, "rms of the lengths' error [m]")
      .def_readonly("rms_sigma", &Misfit::rms_sigma, "rms of error over noise [-]")
      .def_readonly("motion_rms", &Misfit::motion_rms, "rms of the measured motion since rest [m]")
      .def_readonly("nis", &Misfit::nis, "Normalised innovation squared.")
      .def_readonly("dof", &Misfit::dof, "Number of rows in `nis`.")
      .def_readonly("node_error", &Misfit::node_error, "(nodes,) error [m]; NaN where nothing was measured")
      .def_readonly("node_sigmas", &Misfit::node_sigmas, "(nodes,) error over noise; NaN where nothing was measured");
  py::class_<StepResult>(module, "StepResult", "What a step of the estimator gives.")
      .def_readonly("used", &StepResult::used, "False: the frame was skipped for `reason`, and the estimate is unchanged.")
      .def_readonly("reason", &StepResult::reason)
      .def_readonly("estimate", &StepResult::estimate)
      .def_readonly("misfit", &StepResult::misfit)
      .def_readonly("seconds", &StepResult::seconds, "Wall time of each stage [s].")
      .def_property_readonly("state", [](const StepResult& r) { return to_string(r.estimate.state); })
      .def_property_readonly(
          "young_modulus", [](const StepResult& r) { return modulus(r.estimate).mean; }, "[Pa]")
      .def_property_readonly(
          "interval", [](const StepResult& r) { return interval(r.estimate); }, "[Pa]")
      .def("__repr__", [](const StepResult& r) {
        return "<StepResult " + (r.used ? std::string("used") : "skipped: " + r.reason) + ", " + shown(r.estimate) + ">";
      });
  py::class_<Prediction>(module, "Prediction", "A frame's measurement and the model's prediction, row by row.")
      .def_readonly("measured", &Prediction::measured, "(rows,) [m], or [N] of a force")
      .def_readonly("predicted", &Prediction::predicted, "(rows,); NaN where the model has no counterpart")
      .def_readonly("sigma", &Prediction::sigma, "(rows,) standard deviation of the noise")
      .def_property_readonly(
          "places", [](const Prediction& p) { return as_rows(p.places); }, "(rows, 3) [m]")
      .def_readonly("nodes", &Prediction::nodes, "(rows,) nearest mesh node; -1 of a force");
}

void bind_inputs(py::module& module) {
  py::class_<Observation>(module, "Observation", "What one sensor saw at one instant.")
      .def_readonly("source", &Observation::source, "Index in the model's list `observations`.")
      .def_property_readonly(
          "kind", [](const Observation& o) { return traits_of(o.kind).name; },
          "vertices, markers, points, contour, tracks or reaction")
      .def_readonly("time", &Observation::time, "[s] on the recording's clock")
      .def_property_readonly(
          "points", [](const Observation& o) { return as_rows(o.points); },
          "(n, 3) [m]; of tracks those at rest; of a reaction its force (1, 3) [N]; empty for a contour")
      .def_property_readonly(
          "count",
          [](const Observation& o) {
            if (traits_of(o.kind).force) return Eigen::Index{0};
            return o.contour ? o.contour->size() : o.points.cols();
          },
          "Number of points, or of pieces of a contour; 0 of a force.")
      .def_readonly("ids", &Observation::ids,
                    "(n,) mesh vertex, index of a marker, or number of a feature; empty otherwise");
  py::class_<LoadSample>(module, "LoadSample", "One measured value of a load.")
      .def_readonly("topic", &LoadSample::topic)
      .def_readonly("time", &LoadSample::time, "[s] on the recording's clock")
      .def_readonly("value", &LoadSample::value,
                    "(1,) pressure [Pa]; (6,) force [N] and torque [N m]; (12,) position [m] and columns of the rotation");
  py::class_<LoadInput>(module, "LoadInput", "A load that the model's effects ask for.")
      .def_readonly("topic", &LoadInput::topic)
      .def_property_readonly(
          "kind",
          [](const LoadInput& l) {
            if (l.kind == LoadInput::Kind::pressure) return "pressure";
            return l.kind == LoadInput::Kind::wrench ? "wrench" : "pose";
          },
          "pressure, wrench or pose");
  py::class_<TetMesh>(module, "TetMesh", "Tetrahedral mesh at rest; corner nodes come first.")
      .def_property_readonly(
          "nodes", [](const TetMesh& m) { return as_rows(m.nodes); }, "(nodes, 3) [m]")
      .def_property_readonly(
          "tets", [](const TetMesh& m) { return as_rows(m.tets); }, "(tetrahedra, 4 or 10)")
      .def_property_readonly(
          "facets", [](const TetMesh& m) { return as_rows(m.facets); }, "(facets, 3 or 6)")
      .def_readonly("corner_count", &TetMesh::corner_count, "Number of vertices, which observations may name.");
}

}  // namespace

void bind_types(py::module& module) {
  bind_estimate(module);
  bind_step(module);
  bind_inputs(module);
}

}  // namespace tissue_stiffness
