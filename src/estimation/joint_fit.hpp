#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "estimation/shared_parameters.hpp"
#include "filter/posterior_linearization_filter.hpp"
#include "fit/batch_fit.hpp"
#include "fit/recording_fit.hpp"
#include "tissue_stiffness/fit/recording.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// One of several recordings of a body.
struct BodyRecording {
  std::string name;
  ModelSettings settings;
  TetMesh mesh;
  Recording recording;
  bool predicted = false;  ///< it takes no part in the fit, but is foretold by it
};

/// Called with what is done, and how much of it.
using JointProgress = std::function<void(const std::string& what, std::size_t done, std::size_t total)>;

/// Fits the free runs of several recordings of one body. Each is first estimated alone. The best of these estimates, or
/// their mean, is where the joint fit starts. A recording that fits worse than its noise counts less, by its own misfit.
class JointFit {
 public:
  /// The recordings have to outlive this. Throws InputError as Estimator and SharedParameters do, and for a parameter that
  /// drifts.
  JointFit(const std::vector<BodyRecording>& recordings, const std::vector<std::string>& own,
           const JointProgress& progress);

  void run();

  std::size_t size() const { return fits_.size(); }
  const BodyRecording& given(std::size_t recording) const { return recordings_[recording]; }
  RecordingFit& fit(std::size_t recording) const { return *fits_[recording]; }
  const Sharing& sharing() const { return sharing_; }
  const SharedParameters& shared() const { return shared_; }
  std::vector<const Model*> models() const;
  bool studied_in_full() const;

  /// Returns the filter at the most probable parameters.
  const PosteriorLinearizationFilter& filter() const { return filter_; }
  /// Returns the mean square of a recording's errors over its noise's there.
  double misfit_scale(std::size_t recording) const { return misfit_scales_[recording]; }
  /// Returns the estimate by one recording alone; of a predicted one it is empty.
  const Estimate& alone(std::size_t recording) const { return alone_[recording]; }

 private:
  std::vector<FitPart> parts() const;
  double cost(const Eigen::VectorXd& w) const;
  void estimate_alone(std::size_t recording);
  void fit_together(const Eigen::VectorXd& start, const Eigen::VectorXd& spread);

  const std::vector<BodyRecording>& recordings_;
  const JointProgress& progress_;
  Sharing sharing_;
  std::vector<std::unique_ptr<RecordingFit>> fits_;
  SharedParameters shared_;
  Eigen::VectorXd prior_;      ///< standard deviations
  std::vector<double> noise_;  ///< factor on the variance of each recording's noise: its misfit where it is fitted alone
  std::vector<double> misfit_scales_;
  std::vector<Estimate> alone_;
  PosteriorLinearizationFilter filter_;
};

}  // namespace tissue_stiffness
