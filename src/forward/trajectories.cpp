#include <stdexcept>

#include "forward/for_each_index.hpp"
#include "forward/forward_model.hpp"

namespace tissue_stiffness {

ForwardModel::Runs ForwardModel::start_each(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  Runs runs(thetas.size());
  for_each_index(thetas.size(), [&](std::size_t i) { runs[i] = this->start(thetas[i], start); });
  return runs;
}

ForwardModel::Runs ForwardModel::resume_each(const std::vector<Eigen::VectorXd>& thetas, const Trajectory& from) const {
  Runs runs(thetas.size());
  for_each_index(thetas.size(), [&](std::size_t i) { runs[i] = this->resume(thetas[i], from); });
  return runs;
}

std::unique_ptr<Trajectories> ForwardModel::start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  return std::make_unique<SeparateTrajectories>(start_each(thetas, start));
}

std::unique_ptr<Trajectory> ForwardModel::resume(const Eigen::VectorXd&, const Trajectory&) const {
  throw std::logic_error(description() + " cannot be resumed");
}

std::unique_ptr<Trajectories> ForwardModel::resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                                       const Trajectory& from) const {
  return std::make_unique<SeparateTrajectories>(resume_each(thetas, from));
}

std::unique_ptr<Trajectory> ForwardModel::begin(const Eigen::VectorXd& theta, const RunStart& from) const {
  return from.motion ? resume(theta, *from.motion) : start(theta, from.time);
}

void ForwardModel::advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const {
  for (std::size_t k = 0; k < times.size(); ++k) {
    run.advance(times[k]);
    show(k, run.output());
  }
}

std::unique_ptr<Trajectories> ForwardModel::begin_all(const std::vector<Eigen::VectorXd>& thetas,
                                                      const RunStart& from) const {
  return from.motion ? resume_all(thetas, *from.motion) : start_all(thetas, from.time);
}

void SeparateTrajectories::advance(const std::vector<double>& times) {
  for_each_index(runs_.size(), [&](std::size_t i) { runs_[i]->advance(times[i]); });
}

void SeparateTrajectories::outputs(Eigen::MatrixXd& out) const {
  for_each_index(runs_.size(), [&](std::size_t i) { out.col(static_cast<Eigen::Index>(i)) = runs_[i]->output(); });
}

void SeparateTrajectories::combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const {
  const auto displacement = [this](std::size_t i) { return runs_[i]->displacement(); };
  add_weighted(weights, displacement, sum);
}

}  // namespace tissue_stiffness
