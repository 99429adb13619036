#include "experiment.hpp"

#include <numeric>
#include <stdexcept>
#include <string>

namespace tissue_stiffness {
namespace {

constexpr double kSamePlace = 1e-9;  // [m]

}  // namespace

Experiment::Experiment(const ModelSettings& settings, const TetMesh& mesh, const std::vector<double>& truth,
                       const BasisOptions& basis)
    : model_(settings, mesh), forward_(make_forward_model(model_, basis)) {
  set_truth(truth);
}

void Experiment::set_truth(const std::vector<double>& truth) {
  Eigen::VectorXd w = model_.parameters().prior_mean();
  for (std::size_t i = 0; i < truth.size(); ++i) {
    w[static_cast<Eigen::Index>(i)] = model_.parameters().free().at(i).to_coordinate(truth[i]);
  }
  theta_ = model_.parameters().theta(w);
}

void Experiment::add_load(const LoadSample& sample) {
  model_.loads().courses().at(sample.topic)->add(sample.time, sample.value);
}

void Experiment::clear_loads() {
  for (const auto& [topic, course] : model_.loads().courses()) course->clear();
}

std::vector<Experiment::Moment> Experiment::film(double first, double interval, int count) const {
  std::vector<Moment> moments;
  const auto run = forward_->start(theta_, first + model_.settings().time.start);
  for (int k = 0; k < count; ++k) {
    const double time = first + k * interval;
    run->advance(time);
    moments.push_back({time, run->displacement()});
  }
  return moments;
}

Eigen::Matrix3Xd draw(Eigen::Index count, double sigma, std::mt19937& engine) {
  std::normal_distribution<double> normal(0.0, sigma);
  return Eigen::Matrix3Xd::NullaryExpr(3, count, [&] { return normal(engine); });
}

Frame see_vertices(const Experiment& experiment, const Experiment::Moment& moment, const std::vector<int>& ids,
                   double noise, std::mt19937& engine) {
  const auto count = static_cast<Eigen::Index>(ids.size());
  Observation seen;
  seen.time = moment.time;
  seen.ids = Eigen::Map<const Eigen::VectorXi>(ids.data(), count);
  seen.points = draw(count, noise, engine);
  for (Eigen::Index i = 0; i < count; ++i) {
    seen.points.col(i) += experiment.mesh().nodes.col(seen.ids[i]) + moment.displacement.segment<3>(3 * seen.ids[i]);
  }
  return {moment.time, {seen}};
}

std::vector<int> corners(const TetMesh& mesh) {
  std::vector<int> ids(static_cast<std::size_t>(mesh.corner_count));
  std::iota(ids.begin(), ids.end(), 0);
  return ids;
}

std::vector<Frame> see_on(const TetMesh& coarse, const std::vector<int>& ids, const Experiment& finer,
                          const std::vector<Experiment::Moment>& moments, double noise, std::mt19937& engine) {
  const TetMesh& fine = finer.mesh();
  std::vector<int> there;
  for (const int id : ids) {
    Eigen::Index nearest = 0;
    const auto offsets = fine.nodes.leftCols(fine.corner_count).colwise() - coarse.nodes.col(id);
    if (offsets.colwise().squaredNorm().minCoeff(&nearest) > kSamePlace * kSamePlace) {
      throw std::invalid_argument("the finer mesh has no vertex at the coarser one's vertex " + std::to_string(id));
    }
    there.push_back(static_cast<int>(nearest));
  }
  std::vector<Frame> frames;
  for (const Experiment::Moment& moment : moments) {
    frames.push_back(see_vertices(finer, moment, there, noise, engine));
    frames.back().observations.front().ids =
        Eigen::Map<const Eigen::VectorXi>(ids.data(), static_cast<Eigen::Index>(ids.size()));
  }
  return frames;
}

std::vector<Frame> see_all(const Experiment& experiment, const std::vector<Experiment::Moment>& moments, double noise,
                           unsigned seed) {
  const std::vector<int> ids = corners(experiment.mesh());
  std::mt19937 engine(seed);
  std::vector<Frame> frames;
  for (const Experiment::Moment& moment : moments) {
    frames.push_back(see_vertices(experiment, moment, ids, noise, engine));
  }
  return frames;
}

}  // namespace tissue_stiffness
