// This is Yang & Lin (2016): a parameter-only unscented filter (eq. 9-23, in square-root form), with the state of each key
// frame by finite differences (eq. 24, 25). Algorithm 1 goes once through the frames as they come.
#include <cmath>
#include <deque>

#include "estimation/posterior.hpp"
#include "estimation/scheme.hpp"
#include "estimation/stopwatch.hpp"
#include "fem/sparse_solver.hpp"
#include "filter/unscented_filter.hpp"
#include "fit/ensemble.hpp"
#include "forward/full_model.hpp"
#include "observation/frame_misfit.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kHold = 1e4;  // stiffness with which an observed vertex holds the interpolated field, over K's diagonal
constexpr int kStepsPerFrame = 4;
constexpr double kTolerance = 1e-9;  // [m]

class PaperScheme : public Scheme {
 public:
  PaperScheme(ObservedBody& body, const Pace& pace) : Scheme(body, pace), filter_(prior()) {
    for (const ObservationSettings& observation : model_.settings().observations) {
      if (observation.kind != ObservationSettings::Kind::vertices) {
        throw InputError(model_.settings().name + ": observations", "a kind that is not `vertices`",
                         "vertices only with `estimator: paper` (its state is the observed vertices' differences)");
      }
    }
  }

  std::vector<std::string> description() const override {
    return {"paper: parameter-only unscented filter, state by finite differences, " + std::to_string(kStepsPerFrame) +
            " Newmark steps a frame"};
  }
  std::vector<Misfit> free_run(const FreeFrameVisitor& visit) override {
    return body_.compare_free_run(frames_, {body_.start()}, model_.parameters().theta(filter_.mean()), visit);
  }
  Eigen::MatrixXd parameter_covariance() const override { return filter_.covariance(); }

  StepResult process(const Frame& frame) override {
    StepResult result;
    result.estimate = last_.estimate;
    Stopwatch watch(result.seconds);
    frames_.push_back(frame);
    fields_.push_back(interpolate(frame));
    if (fields_.size() < 3) {
      result.reason = "kept until three frames give velocity and acceleration";
      return result;
    }
    if (fields_.size() > 3) fields_.pop_front();
    watch.lap("interpolate");
    update(frame, result);
    watch.lap("update");
    return result;
  }

 protected:
  void forget() override {
    frames_.clear();
    fields_.clear();
    filter_ = prior();
  }

 private:
  UnscentedFilter prior() const {
    return {model_.parameters().prior_mean(), model_.parameters().prior_std().cwiseAbs2().asDiagonal()};
  }

  // Returns the displacement of every node that agrees with the observed vertices and stores the least elastic energy.
  Eigen::VectorXd interpolate(const Frame& frame) {
    const Prediction rest = body_.at_rest(frame);
    if (!holder_.ready() || held_.size() != rest.nodes.size() || held_ != rest.nodes) hold(rest.nodes);
    Eigen::VectorXd load = Eigen::VectorXd::Zero(model_.fem().dof_count());
    for (Eigen::Index i = 0; i < rest.nodes.size(); ++i) {
      const Eigen::Index dof = 3 * rest.nodes[i] + i % 3;
      if (model_.fixed()[static_cast<std::size_t>(dof)] == 0) load[dof] += hold_ * (rest.measured[i] - rest.predicted[i]);
    }
    return holder_.solve(load);
  }

  void hold(const Eigen::VectorXi& nodes) {
    SparseMatrix k = model_.rest_stiffness(model_.parameters().theta(model_.parameters().prior_mean()));
    hold_ = kHold * k.diagonal().mean();
    for (Eigen::Index i = 0; i < nodes.size(); ++i) k.coeffRef(3 * nodes[i] + i % 3, 3 * nodes[i] + i % 3) += hold_;
    fix_dofs(k, model_.fixed(), k.diagonal().mean());
    holder_.factorize(k);
    held_ = nodes;
  }

  // Computes d = f(x; w), from the middle one of the last three frames to the newest.
  DynamicState run(const Eigen::VectorXd& w) const {
    const std::size_t n = frames_.size();
    const double t0 = frames_[n - 3].time, t1 = frames_[n - 2].time, t2 = frames_[n - 1].time;
    const double step = 0.5 * (t2 - t0);
    const ModelSystem system(model_, model_.parameters().theta(w));
    GeneralizedAlpha newmark(system, 1.0, kTolerance);
    DynamicState x;
    x.time = t1;
    x.displacement = fields_[1];
    x.velocity = (fields_[1] - fields_[0]) / (t1 - t0);                             // eq. 24
    x.acceleration = (fields_[2] - 2.0 * fields_[1] + fields_[0]) / (step * step);  // eq. 25
    for (int k = 0; k < kStepsPerFrame; ++k) newmark.step(x, (t2 - t1) / kStepsPerFrame);
    return x;
  }

  void update(const Frame& frame, StepResult& result) {
    const auto outputs = [&](const Eigen::MatrixXd& points) {
      Eigen::MatrixXd rows;
      for (Eigen::Index i = 0; i < points.cols(); ++i) {
        const Eigen::VectorXd u = run(points.col(i)).displacement;
        const Prediction p = predict_frame(model_, body_.operators(), frame, model_.parameters().theta(points.col(i)), u);
        if (i == 0) rows.resize(p.predicted.size(), points.cols());
        rows.col(i) = p.predicted;
      }
      return rows;
    };
    const Prediction rest = body_.at_rest(frame);
    const FilterUpdate innovation =
        filter_.update(rest.measured, outputs(filter_.sigma_points()), Noise::independent(rest.sigma));
    const Eigen::VectorXd u = run(filter_.mean()).displacement;
    last_.prediction = predict_frame(model_, body_.operators(), frame, model_.parameters().theta(filter_.mean()), u);
    last_.set_displacement([u](Eigen::Ref<Eigen::VectorXd> out) { out = u; });
    result.used = true;
    result.misfit = frame_misfit(frame.time, last_.prediction, rest.predicted, model_.mesh().node_count());
    result.misfit.nis = innovation.nis;
    result.misfit.dof = innovation.dof;
    last_.estimate = summarise_posterior(model_.parameters().free(), filter_.mean(), filter_.covariance());
    last_.estimate.time = frame.time;
    last_.estimate.state = EstimateState::converging;
    last_.estimate.state_reason = "the paper's estimator does not test its misfit";
    result.estimate = last_.estimate;
  }

  UnscentedFilter filter_;
  std::vector<Frame> frames_;
  std::deque<Eigen::VectorXd> fields_;  ///< interpolated displacement of the last three frames
  SparseSolver holder_;
  Eigen::VectorXi held_;
  double hold_ = 0.0;
};

}  // namespace

std::unique_ptr<Scheme> make_paper_scheme(ObservedBody& body, const Pace& pace, const ReuseSources&) {
  return std::make_unique<PaperScheme>(body, pace);
}

}  // namespace tissue_stiffness
