#include "tissue_stiffness/estimation/mesh_error.hpp"

#include <variant>

#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/filter/anchored_filter.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"
#include "tissue_stiffness/meshing/bend_boundary.hpp"
#include "tissue_stiffness/meshing/refine.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostNodes = 6000;  // refined eightfold: what still factorises in seconds and within 2 GB

TetMesh finer(const TetMesh& mesh) {
  TetMesh smooth = mesh;
  smooth_boundary(smooth);
  return refine(smooth);
}

void copy_courses(const std::map<std::string, Course>& from, CourseTable& to) {
  for (const auto& [topic, course] : from) *to.at(topic) = course;
}

}  // namespace

struct MeshError::Studies {
  Model coarse, fine;
  ReducedModel coarse_runs, fine_runs;
  std::vector<std::unique_ptr<ObservationOperator>> operators;

  Studies(const ModelSettings& settings, const TetMesh& mesh)
      : coarse(settings, mesh),
        fine(settings, finer(mesh)),
        coarse_runs(coarse),
        fine_runs(fine),
        operators(make_observation_operators(coarse)) {}
};

std::string MeshError::why_not(const ModelSettings& settings, const TetMesh& mesh) {
  if (mesh.node_count() > kMostNodes) return "the mesh has more than " + std::to_string(kMostNodes) + " nodes";
  for (const RegionSettings& region : settings.regions) {
    if (std::holds_alternative<VertexShape>(region.shape)) {
      return "region " + region.name + " lists vertices, which a finer mesh has between them too";
    }
  }
  return "";
}

MeshError::MeshError(const ModelSettings& settings, const TetMesh& mesh)
    : studies_(std::make_unique<Studies>(settings, mesh)) {}
MeshError::~MeshError() = default;

Eigen::VectorXd MeshError::shift(const Question& q) {
  Studies& s = *studies_;
  copy_courses(q.courses, s.coarse.courses());
  copy_courses(q.courses, s.fine.courses());
  AnchoredFilter filter(q.w, q.prior_std);
  filter.move_anchor(q.w, q.spread);
  Ensemble ensemble(s.coarse, s.coarse_runs, s.operators);
  ensemble.restart(filter.sigma_points(), q.start);
  const auto truth = s.fine_runs.start(s.fine.theta(q.w), q.start);
  for (const Frame& frame : q.frames) {
    ensemble.advance(frame.time);
    truth->advance(frame.time);
    const Ensemble::Predicted predicted = ensemble.predict(frame);
    // Nodes of the coarse mesh keep their numbers in the finer one.
    const Eigen::VectorXd u = truth->displacement().head(s.coarse.fem().dof_count());
    const Prediction fine = predict_frame(s.operators, frame, u);
    filter.update(fine.predicted, predicted.rows, fine.sigma.cwiseAbs2(), Eigen::VectorXd::Ones(fine.sigma.size()));
  }
  return filter.mean() - q.w;
}

}  // namespace tissue_stiffness
