#include "tissue_stiffness/forward/for_each_index.hpp"
#include "tissue_stiffness/forward/forward_model.hpp"

namespace tissue_stiffness {

std::vector<std::unique_ptr<Trajectory>> ForwardModel::start_each(const std::vector<Eigen::VectorXd>& thetas,
                                                                  double start) const {
  std::vector<std::unique_ptr<Trajectory>> runs(thetas.size());
  for_each_index(thetas.size(), [&](std::size_t i) { runs[i] = this->start(thetas[i], start); });
  return runs;
}

std::unique_ptr<Trajectories> ForwardModel::start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  return std::make_unique<SeparateTrajectories>(start_each(thetas, start));
}

void SeparateTrajectories::advance(const std::vector<double>& times) {
  for_each_index(runs_.size(), [&](std::size_t i) { runs_[i]->advance(times[i]); });
}

void SeparateTrajectories::displacements(Eigen::MatrixXd& out) const {
  for_each_index(runs_.size(), [&](std::size_t i) { out.col(static_cast<Eigen::Index>(i)) = runs_[i]->displacement(); });
}

Eigen::VectorXd SeparateTrajectories::combined(const Eigen::VectorXd& weights) const {
  return weighted_sum(weights, [this](std::size_t i) { return runs_[i]->displacement(); });
}

}  // namespace tissue_stiffness
