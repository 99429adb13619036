#include <mutex>
#include <optional>
#include <utility>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/model_file.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

/// An estimator that Python's threads may share: one call at a time, while the others run Python.
class SharedEstimator {
 public:
  SharedEstimator(const ModelFile& model, const TetMesh& mesh)
      : stale_after_(model.settings.stale_after), estimator_(model.settings, mesh) {}

  double stale_after() const { return stale_after_; }

  template <typename Call>
  auto alone(const Call& call) {
    const py::gil_scoped_release parallel;
    const std::lock_guard<std::mutex> lock(mutex_);
    return call(estimator_);
  }

 private:
  const double stale_after_;  // the model's
  std::mutex mutex_;
  Estimator estimator_;
};

/// Returns a getter that copies what an estimator's member returns.
template <typename Member>
auto copied(Member member) {
  return [member](SharedEstimator& shared) {
    return shared.alone([&](Estimator& estimator) { return (estimator.*member)(); });
  };
}

/// Returns limits that are checked as the node's are: an estimate may be held to a stricter limit, and to no looser one.
StateLimits state_limits(double converged_within, double stale_after) {
  const double loosest = StateLimits().converged_within;
  if (!(converged_within > 0.0 && converged_within <= loosest)) {
    throw InputError("converged_within", py::str("{:g}").format(converged_within),
                     py::str("more than 0, at most {:g}").format(loosest));
  }
  if (!(stale_after > 0.0)) throw InputError("stale_after", py::str("{:g}").format(stale_after), "a time of more than 0 s");
  StateLimits limits;
  limits.converged_within = converged_within;
  limits.stale_after = stale_after;
  return limits;
}

}  // namespace

void bind_estimator(py::module& module) {
  py::class_<SharedEstimator>(module, "Estimator")
      .def(py::init([](const ModelFile& model, const TetMesh& mesh) {
             const py::gil_scoped_release parallel;
             return std::make_unique<SharedEstimator>(model, mesh);
           }),
           py::arg("model"), py::arg("mesh"))
      .def(
          "step",
          [](SharedEstimator& shared, const Frame& frame, const std::vector<LoadSample>& loads) {
            return shared.alone([&](Estimator& estimator) {
              for (const LoadSample& load : loads) estimator.add_load(load);
              return estimator.step(frame);
            });
          },
          py::arg("frame"), py::arg("loads"))
      .def(
          "add_load",
          [](SharedEstimator& shared, const LoadSample& load) {
            shared.alone([&](Estimator& estimator) { estimator.add_load(load); });
          },
          py::arg("load"))
      .def(
          "set_first_stamp",
          [](SharedEstimator& shared, double time) {
            shared.alone([&](Estimator& estimator) { estimator.set_first_stamp(time); });
          },
          py::arg("stamp"))
      .def(
          "set_state_limits",
          [](SharedEstimator& shared, double converged_within, const std::optional<double>& stale_after) {
            const StateLimits limits = state_limits(converged_within, stale_after.value_or(shared.stale_after()));
            shared.alone([&](Estimator& estimator) { estimator.set_state_limits(limits); });
          },
          py::arg("converged_within") = StateLimits().converged_within, py::arg("stale_after") = std::nullopt)
      .def("reset", copied(&Estimator::reset))
      .def("load_inputs", copied(&Estimator::load_inputs))
      .def("mesh", copied(&Estimator::mesh))
      .def("estimate", copied(&Estimator::estimate))
      .def("displacement",
           [](SharedEstimator& shared) {
             return shared.alone([](Estimator& estimator) { return as_rows(estimator.displacement()); });
           })
      .def("prediction", copied(&Estimator::prediction))
      .def("identifiability", copied(&Estimator::identifiability))
      .def("basis_error", copied(&Estimator::basis_error))
      .def("description", copied(&Estimator::description))
      .def("free_run",
           [](SharedEstimator& shared) { return shared.alone([](Estimator& estimator) { return estimator.free_run(); }); });
}

}  // namespace tissue_stiffness
