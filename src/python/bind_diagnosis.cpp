#include <chrono>
#include <future>
#include <mutex>
#include <tuple>
#include <utility>

#include "diagnosis/estimate_at_last.hpp"
#include "python/arrays.hpp"
#include "python/bindings.hpp"
#include "python/model_file.hpp"
#include "report/write_diagnosis.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/stop_request.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

constexpr std::chrono::milliseconds kPause{50};  // between two looks at Ctrl-C

/// What the work on its own thread tells the one that waits for it.
class LatestStep {
 public:
  using Step = std::tuple<std::string, std::size_t, std::size_t>;

  void set(Step step) {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (step != step_) told_ = false;
    step_ = std::move(step);
  }

  /// Calls `tell` unless it has heard of the latest step.
  void tell(const py::object& tell) {
    Step step;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (told_ || tell.is_none()) return;
      told_ = true;
      step = step_;
    }
    tell(std::get<0>(step), std::get<1>(step), std::get<2>(step));
  }

 private:
  std::mutex mutex_;
  Step step_;
  bool told_ = true;
};

/// Runs the diagnosis on a thread of its own. This one hears Ctrl-C meanwhile, and tells Python of each step. An exception
/// from Python ends the work.
Diagnosis diagnose_beside(const ModelFile& model, const TetMesh& mesh, const Recording& recording, DiagnosisOptions options,
                          StopRequest& stop, const py::object& progress) {
  LatestStep latest;
  options.progress = [&latest](const std::string& what, std::size_t done, std::size_t total) {
    latest.set({what, done, total});
  };
  auto diagnosis = std::async(std::launch::async, [&] { return diagnose(model.settings, mesh, recording, options); });
  try {
    for (;;) {
      {
        const py::gil_scoped_release parallel;
        if (diagnosis.wait_for(kPause) == std::future_status::ready) break;
      }
      if (PyErr_CheckSignals() != 0) throw py::error_already_set();
      latest.tell(progress);
    }
    latest.tell(progress);
  } catch (...) {
    stop.stop();
    const py::gil_scoped_release parallel;
    diagnosis.wait();
    throw;
  }
  return diagnosis.get();
}

std::pair<std::string, std::string> diagnose_frames(const ModelFile& model, const TetMesh& mesh, std::vector<Frame> frames,
                                                    std::vector<LoadSample> loads, double first_stamp,
                                                    std::vector<std::string> add, std::vector<std::string> ignore,
                                                    bool automatic, double time_limit, const py::object& progress) {
  StopRequest stop;
  if (time_limit > 0.0) stop.end_after(time_limit);
  Recording recording;
  recording.frames = std::move(frames);
  recording.loads = std::move(loads);
  recording.first_stamp = first_stamp;
  recording.checkpoint = [&stop] { stop.check(); };
  DiagnosisOptions options;
  options.add = std::move(add);
  options.ignore = std::move(ignore);
  options.automatic = automatic;
  options.at_end = [](Diagnosis& found, FittedModel& given, FittedModel& last, const RecordingFit* finer) {
    try {
      found.estimate = estimate_at_last(found, given, last, finer);
    } catch (const NumericalError&) {
      // The fit's own estimate stays, as with a prior that reaches impossible values.
    }
  };
  const Diagnosis diagnosis = diagnose_beside(model, mesh, recording, std::move(options), stop, progress);
  return {diagnosis_json(diagnosis), extend_model(model.text, diagnosis.entries, model.settings.directory)};
}

}  // namespace

void bind_diagnosis(py::module& module) {
  module.def("diagnose", &diagnose_frames, py::arg("model"), py::arg("mesh"), py::arg("frames"), py::arg("loads"),
             py::arg("first_stamp"), py::arg("add"), py::arg("ignore"), py::arg("automatic"), py::arg("time_limit"),
             py::arg("progress"), "Returns diagnosis.json and model_next.yaml, as texts.");
}

}  // namespace tissue_stiffness
