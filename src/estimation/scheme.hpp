#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "estimation/last_frame.hpp"
#include "estimation/observed_body.hpp"
#include "tissue_stiffness/estimation/estimator.hpp"

namespace tissue_stiffness {

/// The pace tells how frames come.
struct Pace {
  bool background = false;         ///< long work may run beside the frames
  bool replaying = false;          ///< the frames were measured before
  bool more_follow = false;        ///< of a replay: questions about the whole recording wait for its last frame
  const Estimate* near = nullptr;  ///< estimate from elsewhere that a replay starts with; null: none

  /// Frames do not wait for reprocessing, which runs in the background.
  bool hurried() const { return background && !replaying; }
};

/// A scheme turns frames into an estimate. It is the interface of a filter: the estimator has checked each frame before.
class Scheme {
 public:
  /// Body and pace have to outlive the scheme.
  Scheme(ObservedBody& body, const Pace& pace)
      : body_(body), model_(body.model()), pace_(pace), last_(body.prior_estimate(), body.model().mesh().node_count()) {}
  virtual ~Scheme() = default;
  Scheme(const Scheme&) = delete;
  Scheme& operator=(const Scheme&) = delete;

  /// Updates the estimate with a frame. What it throws refuses the frame, and the estimate stays.
  virtual StepResult process(const Frame& frame) = 0;
  /// Goes back to the prior.
  void reset() {
    stop();
    last_ = LastFrame(body_.prior_estimate(), body_.model().mesh().node_count());
    forget();
  }

  /// Returns what reprocessing has brought since the last frame, if one has ended.
  virtual std::optional<StepResult> take_reprocessed() { return std::nullopt; }
  virtual bool reprocesses() const { return false; }
  /// Ends the model's runs in the background, before anything that they read is changed.
  virtual void stop() {}

  LastFrame& last() { return last_; }
  const LastFrame& last() const { return last_; }
  virtual Eigen::MatrixXd parameter_covariance() const = 0;  ///< in the filter's coordinates
  virtual std::vector<std::string> description() const = 0;
  /// Returns the error of the reduced basis [m], kBasisSafety included. There is none for a model that runs in full, and
  /// before a few frames.
  virtual std::optional<double> basis_error() const { return std::nullopt; }
  virtual std::vector<Misfit> free_run(const FreeFrameVisitor& visit) = 0;

 protected:
  virtual void forget() = 0;

  ObservedBody& body_;
  Model& model_;
  const Pace& pace_;
  LastFrame last_;
};

#define ESTIMATOR(name) \
  std::unique_ptr<Scheme> make_##name##_scheme(ObservedBody& body, const Pace& pace, const ReuseSources& relatives);
#include "settings/estimators.def"
#undef ESTIMATOR

}  // namespace tissue_stiffness
