#include "tissue_stiffness/estimation/mesh_error.hpp"

#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"
#include "tissue_stiffness/meshing/bend_boundary.hpp"
#include "tissue_stiffness/meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 6;
constexpr double kLongestStep = 0.1;  // prior standard deviations at once
constexpr int kMostNodes = 6000;      // refined eightfold: what still factorises in seconds and within 2 GB

void drive(const MeshError::Question& question, Model& model) {
  for (const auto& [topic, course] : question.courses) *model.courses().at(topic) = course;
  model.set_first_stamp(question.first_stamp);
}

}  // namespace

TetMesh finer(const TetMesh& mesh) {
  TetMesh smooth = mesh;
  smooth_boundary(smooth);
  return refine(smooth);
}

struct MeshError::Studies {
  Model coarse, fine;
  ReducedModel coarse_runs, fine_runs;
  std::vector<std::unique_ptr<ObservationOperator>> operators;

  Studies(const ModelSettings& settings, const TetMesh& mesh)
      : coarse(settings, mesh),
        fine(settings, finer(mesh), refine(coarse.regions(), mesh, finer(mesh))),
        coarse_runs(coarse),
        fine_runs(fine),
        operators(make_observation_operators(coarse)) {}
};

std::string MeshError::why_not(const TetMesh& mesh) {
  return mesh.node_count() > kMostNodes ? "the mesh has more than " + std::to_string(kMostNodes) + " nodes" : "";
}

MeshError::MeshError(const ModelSettings& settings, const TetMesh& mesh)
    : studies_(std::make_unique<Studies>(settings, mesh)) {}
MeshError::~MeshError() = default;

Eigen::VectorXd MeshError::shift(const Question& q) {
  Studies& s = *studies_;
  drive(q, s.coarse);
  drive(q, s.fine);
  // Nodes of the coarse mesh keep their numbers in the finer one, whose run is seen through them.
  std::vector<Prediction> truth;
  const Eigen::VectorXd theta = s.fine.theta(q.w);
  const auto run = s.fine_runs.start(theta, q.start);
  for (const Frame& frame : q.frames) {
    run->advance(frame.time - s.fine.delay(theta));
    const Eigen::VectorXd u = run->displacement().head(s.coarse.fem().dof_count());
    truth.push_back(predict_frame(s.coarse, s.operators, frame, theta, u));
  }
  AnchoredFilter filter(q.w, q.prior_std.cwiseAbs2().asDiagonal());
  Ensemble ensemble(s.coarse, s.coarse_runs, s.operators);
  Eigen::VectorXd fit = q.w;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    filter.move_anchor(fit, q.spread);
    ensemble.restart(filter.sigma_points(), {q.start});
    for (std::size_t k = 0; k < q.frames.size(); ++k) {
      ensemble.advance(q.frames[k].time);
      const Eigen::MatrixXd rows = ensemble.predict(q.frames[k]).rows;
      const Eigen::VectorXd& sigma = truth[k].sigma;
      filter.update(truth[k].predicted, rows, sigma.cwiseAbs2(), Eigen::VectorXd::Ones(sigma.size()));
    }
    const Eigen::VectorXd limit = kLongestStep * q.prior_std;
    const Eigen::VectorXd step = (filter.mean() - fit).cwiseMax(-limit).cwiseMin(limit);
    fit += step;
    if ((step.array().abs() < 0.1 * (fit - q.w).array().abs()).all()) break;
  }
  return fit - q.w;
}

}  // namespace tissue_stiffness
