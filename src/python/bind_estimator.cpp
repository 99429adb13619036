#include <mutex>
#include <utility>

#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/model_file.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

/// An estimator that Python's threads may share: one call at a time, while the others run Python.
class SharedEstimator {
 public:
  SharedEstimator(const ModelFile& model, const TetMesh& mesh) : estimator_(model.settings, mesh) {}

  template <typename Call>
  auto alone(const Call& call) {
    const py::gil_scoped_release parallel;
    const std::lock_guard<std::mutex> lock(mutex_);
    return call(estimator_);
  }

 private:
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
