#include "tissue_stiffness/forward/for_each_index.hpp"
#include "tissue_stiffness/forward/forward_model.hpp"

namespace tissue_stiffness {

std::unique_ptr<Trajectories> ForwardModel::start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  std::vector<std::unique_ptr<Trajectory>> runs(thetas.size());
  for_each_index(thetas.size(), [&](std::size_t i) { runs[i] = this->start(thetas[i], start); });
  return std::make_unique<SeparateTrajectories>(std::move(runs));
}

void SeparateTrajectories::advance(const std::vector<double>& times) {
  for_each_index(runs_.size(), [&](std::size_t i) { runs_[i]->advance(times[i]); });
}

void SeparateTrajectories::displacements(Eigen::MatrixXd& out) const {
  for_each_index(runs_.size(), [&](std::size_t i) { out.col(static_cast<Eigen::Index>(i)) = runs_[i]->displacement(); });
}

Eigen::VectorXd SeparateTrajectories::combined(const Eigen::VectorXd& weights) const {
  Eigen::VectorXd sum = weights[0] * runs_.front()->displacement();
  for (std::size_t i = 1; i < runs_.size(); ++i) sum += weights[static_cast<Eigen::Index>(i)] * runs_[i]->displacement();
  return sum;
}

}  // namespace tissue_stiffness
