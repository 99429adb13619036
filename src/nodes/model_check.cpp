#include "nodes/model_check.hpp"

#include <algorithm>

#include "estimation/low_priority.hpp"
#include "tissue_stiffness/diagnosis/diagnose.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/freed_memory.hpp"

namespace tissue_stiffness {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostFrames = 200;    // that a check uses; more are thinned
constexpr std::size_t kMostLoads = 500000;  // 40 minutes at 200 Hz
constexpr std::size_t kFewestFrames = 24;   // for a check that nobody asked for

std::vector<Frame> thinned(const std::deque<Frame>& frames) {
  const std::size_t count = std::min(frames.size(), kMostFrames);
  std::vector<Frame> kept;
  for (std::size_t k = 0; k < count; ++k) kept.push_back(frames[k * frames.size() / count]);
  return kept;
}

}  // namespace

struct ModelCheck::Job {
  ModelSettings settings;
  TetMesh mesh;
  Recording recording;
};

ModelCheck::ModelCheck(const Options& options, Report report) : report_(std::move(report)), options_(options) {
  thread_ = std::thread([this] { run(); });
}

void ModelCheck::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopped_ = given_up_ = true;
    outcome_ = {std::nullopt, "the node is ending"};
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void ModelCheck::set_options(const Options& options) {
  const std::lock_guard<std::mutex> lock(mutex_);
  options_ = options;
  changed_.notify_all();
}

void ModelCheck::start(const ModelSettings& settings, const TetMesh& mesh) {
  const std::lock_guard<std::mutex> lock(mutex_);
  settings_ = settings;
  mesh_ = mesh;
  last_.reset();
  given_up_ = news_ = true;
  took_.reset();
  changed_.notify_all();
}

void ModelCheck::start_epoch(double first_stamp) {
  const std::lock_guard<std::mutex> lock(mutex_);
  first_stamp_ = first_stamp;
  frames_.clear();
  loads_.clear();
  complete_ = true;
}

void ModelCheck::add(const LoadSample& load) {
  const std::lock_guard<std::mutex> lock(mutex_);
  loads_.push_back(load);
  if (loads_.size() <= kMostLoads) return;
  loads_.pop_front();
  complete_ = false;
}

void ModelCheck::add(const Frame& frame) {
  const std::lock_guard<std::mutex> lock(mutex_);
  frames_.push_back(frame);
  while (frames_.front().time < frame.time - options_.window) frames_.pop_front();
  news_ = true;
  if (due()) changed_.notify_all();
}

Recording ModelCheck::recording() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  Recording out;
  out.frames.assign(frames_.begin(), frames_.end());
  out.loads.assign(loads_.begin(), loads_.end());
  out.first_stamp = first_stamp_;
  return out;
}

bool ModelCheck::complete() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return complete_;
}

std::optional<Diagnosis> ModelCheck::last() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return last_;
}

Diagnosis ModelCheck::check() {
  std::unique_lock<std::mutex> lock(mutex_);
  if (!settings_) throw InputError("diagnose", "no mesh yet", "a running model");
  if (!complete_) throw InputError("diagnose", "a run longer than its loads are kept", "a run since the last reset");
  const unsigned request = ++requests_;
  changed_.notify_all();
  changed_.wait(lock, [&] { return stopped_ || served_ >= request; });
  if (outcome_.diagnosis) return *outcome_.diagnosis;
  throw NumericalError(outcome_.fault);
}

bool ModelCheck::due() const {
  if (!settings_ || !complete_) return false;
  if (served_ < requests_) return true;
  if (!(options_.period > 0.0) || !news_ || frames_.size() < kFewestFrames) return false;
  return !took_ || Clock::now() - ended_ >= std::max(std::chrono::duration<double>(options_.period), *took_);
}

ModelCheck::Job ModelCheck::next_job() {
  Job job{*settings_, mesh_, {}};
  job.recording.frames = thinned(frames_);
  job.recording.loads.assign(loads_.begin(), loads_.end());
  job.recording.first_stamp = first_stamp_;
  job.recording.checkpoint = [this] {
    if (given_up_) throw NumericalError("given up, because the model or the node changed");
  };
  return job;
}

ModelCheck::Outcome ModelCheck::carry_out(Job& job) const {
  const double rest = job.recording.first_stamp + job.settings.time.start;
  auto& frames = job.recording.frames;
  frames.erase(std::remove_if(frames.begin(), frames.end(), [&](const Frame& frame) { return frame.time < rest; }),
               frames.end());
  try {
    return {diagnose(job.settings, job.mesh, job.recording, {}), ""};
  } catch (const std::exception& error) {
    return {std::nullopt, error.what()};
  }
}

void ModelCheck::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  while (!stopped_) {
    if (!due()) {
      changed_.wait_for(lock, std::chrono::milliseconds(200));
      continue;
    }
    news_ = given_up_ = false;
    const unsigned request = requests_;
    Job job = next_job();
    const double stamp = job.recording.frames.empty() ? 0.0 : job.recording.frames.back().time;
    lock.unlock();
    const auto begin = Clock::now();
    Outcome outcome;
    run_at_low_priority([&] { outcome = carry_out(job); });
    return_freed_memory();  // hundreds of megabytes
    const auto end = Clock::now();
    if (outcome.diagnosis && !given_up_) report_(*outcome.diagnosis, stamp);
    lock.lock();
    if (given_up_) continue;  // the changed model is due, requests are still open
    outcome_ = std::move(outcome);
    last_ = outcome_.diagnosis;
    ended_ = end;
    took_ = end - begin;
    served_ = request;
    changed_.notify_all();
  }
}

}  // namespace tissue_stiffness
