#pragma once

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "tissue_stiffness/diagnosis/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Looks for what the running model misses, beside the estimator: one thread of low priority that runs on one core, over a
/// copy of the last seconds. All members may be called from any thread.
class ModelCheck {
 public:
  struct Options {
    double period =
        0.0;  ///< [s] of wall time between checks, and at least as long as the last one took; 0: on request only
    double window = 0.0;  ///< [s] of frames that are kept
  };
  /// What a check found in frames up to `stamp`.
  using Report = std::function<void(const Diagnosis& diagnosis, double stamp)>;

  ModelCheck(const Options& options, Report report);
  ~ModelCheck() { stop(); }
  ModelCheck(const ModelCheck&) = delete;
  ModelCheck& operator=(const ModelCheck&) = delete;

  /// Gives up a check in progress and ends the thread; who waits for one gets its NumericalError.
  void stop();

  /// From now on this is the running model; a check in progress is given up, the next one is due.
  void start(const ModelSettings& settings, const TetMesh& mesh);
  /// Another run of the experiment: frames and loads are forgotten.
  void start_lap(double first_stamp);
  void add(const LoadSample& load);
  void add(const Frame& frame);

  /// What is kept of this lap.
  Recording recording() const;
  /// False when it lacks loads that acted since the start: nothing can be run again then.
  bool complete() const;
  /// The last one of the running model.
  std::optional<Diagnosis> last() const;
  /// Checks now, in the thread, and waits for it. Throws InputError when there is no model or too little data,
  /// NumericalError when the model cannot be run or the check was given up.
  Diagnosis check();

 private:
  struct Job;
  struct Outcome {
    std::optional<Diagnosis> diagnosis;
    std::string fault;
  };
  void run();
  bool due() const;
  Job next_job();
  Outcome carry_out(Job& job) const;

  const Options options_;
  const Report report_;
  mutable std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<ModelSettings> settings_;
  TetMesh mesh_;
  double first_stamp_ = 0.0;
  std::deque<Frame> frames_;
  std::deque<LoadSample> loads_;
  bool complete_ = true;  ///< no load of this lap was dropped
  bool news_ = false;     ///< since the last check
  bool stopped_ = false;
  unsigned requests_ = 0, served_ = 0;  ///< by check()
  std::atomic<bool> given_up_{false};
  std::chrono::steady_clock::time_point next_;
  std::optional<Diagnosis> last_;
  Outcome outcome_;
  std::thread thread_;
};

}  // namespace tissue_stiffness
