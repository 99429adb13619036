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

#include "tissue_stiffness/fit/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/diagnosis.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// Searches for what the running model misses, in the background. One thread of low priority runs on one core and uses a
/// copy of the last seconds. All members may be called from any thread.
class ModelCheck {
 public:
  struct Options {
    double period = 0.0;  ///< wall time between checks [s], at least the time of the last one; 0: on request only
    double window = 0.0;  ///< time span of the frames that are kept [s]
  };
  /// Receives the result of a check of the frames up to `stamp`.
  using Report = std::function<void(const Diagnosis& diagnosis, double stamp)>;

  ModelCheck(const Options& options, Report report);
  ~ModelCheck() { stop(); }
  ModelCheck(const ModelCheck&) = delete;
  ModelCheck& operator=(const ModelCheck&) = delete;

  /// Takes other options. A shorter window forgets older frames at the next one.
  void set_options(const Options& options);

  /// Cancels a check in progress and ends the thread. A caller that waits for the check gets its NumericalError.
  void stop();

  /// Sets the running model. A check in progress is cancelled, and the next one is due.
  void start(const ModelSettings& settings, const TetMesh& mesh);
  /// Starts another run of the experiment. Frames and loads are forgotten.
  void start_epoch(double first_stamp);
  void add(const LoadSample& load);
  void add(const Frame& frame);

  /// Returns what is kept of this epoch.
  Recording recording() const;
  /// Returns false when loads since the start were dropped, so that nothing can be run again.
  bool complete() const;
  /// Returns the last diagnosis of the running model.
  std::optional<Diagnosis> last() const;
  /// Runs a check now, in the thread, and waits for it. Throws InputError when there is no model or loads of this run were
  /// dropped. Throws NumericalError when there are too few data, the model cannot be run, or the check was cancelled.
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

  const Report report_;
  mutable std::mutex mutex_;
  Options options_;
  std::condition_variable changed_;
  std::optional<ModelSettings> settings_;
  TetMesh mesh_;
  double first_stamp_ = 0.0;
  std::deque<Frame> frames_;
  std::deque<LoadSample> loads_;
  bool complete_ = true;  ///< no load of this epoch was dropped
  bool news_ = false;     ///< a frame or model came since the last check
  bool stopped_ = false;
  unsigned requests_ = 0, served_ = 0;  ///< requests by check(), and the last one that was served
  std::atomic<bool> given_up_{false};
  std::chrono::steady_clock::time_point ended_;        ///< the last check
  std::optional<std::chrono::duration<double>> took_;  ///< the last check; none: of a running model there was none yet
  std::optional<Diagnosis> last_;
  Outcome outcome_;
  std::thread thread_;
};

}  // namespace tissue_stiffness
