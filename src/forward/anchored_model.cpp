#include "tissue_stiffness/forward/anchored_model.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <exception>

namespace tissue_stiffness {
namespace {

Eigen::MatrixXd displacements(const ForwardModel& model, const Eigen::VectorXd& theta, double start,
                              const std::vector<double>& times) {
  const auto run = model.start(theta, start);
  Eigen::MatrixXd u(run->displacement().size(), static_cast<Eigen::Index>(times.size()));
  for (std::size_t k = 0; k < times.size(); ++k) {
    run->advance(times[k]);
    u.col(static_cast<Eigen::Index>(k)) = run->displacement();
  }
  return u;
}

class AnchoredTrajectory : public Trajectory {
 public:
  AnchoredTrajectory(std::unique_ptr<Trajectory> run, const std::vector<double>& times, const Eigen::MatrixXd& difference)
      : run_(std::move(run)), times_(times), difference_(difference) {}

  void advance(double time) override { run_->advance(time); }
  double time() const override { return run_->time(); }
  Eigen::VectorXd displacement() const override { return run_->displacement() + at(run_->time()); }
  Eigen::VectorXd velocity() const override { return run_->velocity(); }

 private:
  Eigen::VectorXd at(double time) const {
    const auto next = std::lower_bound(times_.begin(), times_.end(), time);
    if (next == times_.end()) return difference_.rightCols<1>();
    const auto k = static_cast<Eigen::Index>(next - times_.begin());
    if (k == 0 || *next == time) return difference_.col(k);
    const double share = (time - *(next - 1)) / (*next - *(next - 1));
    return (1.0 - share) * difference_.col(k - 1) + share * difference_.col(k);
  }

  std::unique_ptr<Trajectory> run_;
  const std::vector<double>& times_;
  const Eigen::MatrixXd& difference_;
};

}  // namespace

void AnchoredModel::anchor(const Eigen::VectorXd& theta, double start, const std::vector<double>& times) {
  Eigen::MatrixXd accurate, cheap;
  tbb::parallel_invoke([&] { accurate = displacements(*accurate_, theta, start, times); },
                       [&] { cheap = displacements(*cheap_, theta, start, times); });
  times_ = times;
  difference_ = accurate - cheap;
}

std::unique_ptr<Trajectory> AnchoredModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<AnchoredTrajectory>(cheap_->start(theta, start), times_, difference_);
}

std::string AnchoredModel::description() const {
  return cheap_->description() + ", moved to agree with: " + accurate_->description();
}

}  // namespace tissue_stiffness
