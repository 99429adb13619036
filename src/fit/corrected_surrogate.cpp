#include "fit/corrected_surrogate.hpp"

#include <algorithm>
#include <utility>

#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFarthest = 1.0;  // lengths of the last move: nothing is known farther away

class CorrectedTrajectory : public Trajectory {
 public:
  CorrectedTrajectory(std::unique_ptr<Trajectory> run, const std::vector<double>& times, const Eigen::MatrixXd& difference,
                      const Eigen::MatrixXd& change, double share)
      : run_(std::move(run)), times_(times), difference_(difference), change_(change), share_(share) {}

  void advance(double time) override { run_->advance(time); }
  double time() const override { return run_->time(); }
  Eigen::VectorXd displacement() const override {
    const Eigen::VectorXd quick = run_->displacement();
    return quick + at(run_->time()).head(quick.size());
  }
  Eigen::VectorXd output() const override { return run_->output() + at(run_->time()); }
  Eigen::VectorXd velocity() const override { return run_->velocity(); }

 private:
  Eigen::VectorXd at(double time) const {
    const auto next = std::lower_bound(times_.begin(), times_.end(), time);
    const auto last = static_cast<Eigen::Index>(times_.size()) - 1;
    if (next == times_.end()) return at(last);
    const auto k = static_cast<Eigen::Index>(next - times_.begin());
    if (k == 0 || *next == time) return at(k);
    const double part = (time - *(next - 1)) / (*next - *(next - 1));
    return (1.0 - part) * at(k - 1) + part * at(k);
  }
  Eigen::VectorXd at(Eigen::Index k) const {
    if (share_ == 0.0) return difference_.col(k);
    return difference_.col(k) + share_ * change_.col(k);
  }

  std::unique_ptr<Trajectory> run_;
  const std::vector<double>& times_;
  const Eigen::MatrixXd &difference_, &change_;
  double share_;
};

}  // namespace

Eigen::MatrixXd run_outputs(const ForwardModel& model, const Eigen::VectorXd& theta, double start,
                            const std::vector<double>& times, const std::function<void()>& checkpoint) {
  const auto run = model.start(theta, start);
  Eigen::MatrixXd u(run->output().size(), static_cast<Eigen::Index>(times.size()));
  for (std::size_t k = 0; k < times.size(); ++k) {
    checkpoint();
    run->advance(times[k]);
    u.col(static_cast<Eigen::Index>(k)) = run->output();
  }
  return u;
}

void CorrectedSurrogate::anchor(const Eigen::VectorXd& theta, double start, const std::vector<double>& times,
                                const std::function<void()>& checkpoint) {
  Eigen::MatrixXd accurate, cheap;
  run_side_by_side([&] { accurate = run_outputs(*accurate_, theta, start, times, checkpoint); },
                   [&] { cheap = run_outputs(*cheap_, theta, start, times, checkpoint); });
  agree(theta, times, accurate - cheap);
}

void CorrectedSurrogate::agree(const Eigen::VectorXd& theta, const std::vector<double>& times, Eigen::MatrixXd difference) {
  times_ = times;
  anchor_ = theta;
  difference_ = std::move(difference);
}

void CorrectedSurrogate::anchor_to(const Eigen::MatrixXd& accurate, const Eigen::VectorXd& theta, double start,
                                   const std::vector<double>& times, const std::function<void()>& checkpoint) {
  agree(theta, times, accurate - run_outputs(*cheap_, theta, start, times, checkpoint));
}

void CorrectedSurrogate::anchor_as(const CorrectedSurrogate& other, const Eigen::VectorXd& theta, double start,
                                   const std::function<void()>& checkpoint) {
  anchor_to(run_outputs(other, other.anchor_, start, other.times_, checkpoint), theta, start, other.times_, checkpoint);
}

void CorrectedSurrogate::follow(const CorrectedSurrogate& before, const Eigen::VectorXd& scale) {
  const Eigen::VectorXd move = (scale.array() > 0.0).select((anchor_ - before.anchor_).cwiseQuotient(scale), 0.0);
  if (!(move.squaredNorm() > 0.0)) return;
  change_ = difference_ - before.difference_;
  along_ = (scale.array() > 0.0).select(move.cwiseQuotient(scale), 0.0) / move.squaredNorm();
}

std::unique_ptr<Trajectory> CorrectedSurrogate::start(const Eigen::VectorXd& theta, double start) const {
  const double share = along_.size() > 0 ? std::clamp(along_.dot(theta - anchor_), -kFarthest, kFarthest) : 0.0;
  return std::make_unique<CorrectedTrajectory>(cheap_->start(theta, start), times_, difference_, change_, share);
}

std::string CorrectedSurrogate::description() const {
  return cheap_->description() + ", moved to agree with: " + accurate_->description();
}

}  // namespace tissue_stiffness
