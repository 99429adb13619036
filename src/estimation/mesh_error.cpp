#include "estimation/mesh_error.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

#include "filter/posterior_linearization_filter.hpp"
#include "fit/coordinate_scan.hpp"
#include "fit/ensemble.hpp"
#include "forward/extra_force.hpp"
#include "forward/study_model.hpp"
#include "meshing/bend_boundary.hpp"
#include "meshing/refine.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tissue_stiffness/types/estimate.hpp"
#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVectors = 24;  // vectors of the finer mesh's basis: with 16 and with 48 E moves by less than 1e-4
constexpr int kMostIterations = 12;
constexpr int kMostCuts = 4;
constexpr double kSettled = 0.1;           // of the shift
constexpr double kNegligible = 1e-5;       // prior standard deviations
constexpr double kLongestStep = 0.1;       // prior standard deviations at once
constexpr double kTelling = 0.1;           // mean square of a mesh's misfit in sigmas that a recording would show
constexpr double kLeftByCorrection = 0.5;  // of the mesh's effect, 1 sigma
constexpr int kMostNodes = 17000;          // nodes: refined eightfold, they still factorise within half a minute
constexpr double kMemory = 0.4e-3;         // GB for each node
constexpr double kMostMemory = 0.5;        // of the available memory

// Returns the memory that is available [GB]; infinity where the system does not say.
double available_memory() {
  std::ifstream file("/proc/meminfo");
  std::string name, unit;
  for (double kilobytes = 0.0; file >> name >> kilobytes; std::getline(file, unit)) {
    if (name == "MemAvailable:") return 1e-6 * kilobytes;
  }
  return std::numeric_limits<double>::infinity();
}

// Returns 1 for each free parameter that is a Young's modulus, else 0.
Eigen::VectorXd young_moduli(const std::vector<FreeParameter>& free) {
  Eigen::VectorXd out(static_cast<Eigen::Index>(free.size()));
  for (std::size_t i = 0; i < free.size(); ++i)
    out[static_cast<Eigen::Index>(i)] = is_young_modulus(free[i].name) ? 1.0 : 0.0;
  return out;
}

// Runs Gauss-Newton from `start`, with steps that are cut while they do not lower the cost. It ends where none does.
template <typename Run>
MeshError::Answer fit(const Run& run, PosteriorLinearizationFilter filter, const MeshError::Question& q,
                      const Eigen::VectorXd& start) {
  run(filter, start);
  const Eigen::VectorXd limit = kLongestStep * q.prior_std;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    const PosteriorLinearizationFilter before = filter;
    Eigen::VectorXd step = (before.mean() - before.anchor()).cwiseMax(-limit).cwiseMin(limit);
    const auto settled = [&](const Eigen::VectorXd& at) {
      return (step.array().abs() < kSettled * (at - q.w).array().abs() + kNegligible * q.prior_std.array()).all();
    };
    if (settled(before.mean())) return {before.mean() - q.w, before.mean_square()};
    bool better = false;
    for (int cut = 0; cut < kMostCuts && !better; ++cut, step *= 0.3) {
      run(filter, before.anchor() + step);
      better = filter.cost() < before.cost();
    }
    if (!better) return {before.anchor() - q.w, before.mean_square()};
  }
  throw NumericalError("the fit to a finer mesh does not settle");
}

}  // namespace

TetMesh refined_mesh(const TetMesh& mesh, const MeshSettings& settings) {
  return refine_mesh(smooth_unless_faceted(settings, mesh));
}

BasisOptions basis_beside(const TetMesh& mesh, const TetMesh& finer) {
  BasisOptions basis;
  basis.size = kVectors;
  basis.coarser = std::make_shared<const Prolongation>(prolongation(mesh, finer));
  return basis;
}

Eigen::MatrixXd mesh_discrepancy(const Model& model, const Eigen::VectorXd& shift) {
  return mesh_discrepancy(model.parameters().free(), !studied_in_full(model), shift);
}

Eigen::MatrixXd mesh_discrepancy(const std::vector<FreeParameter>& free, bool of_linear_form,
                                 const Eigen::VectorXd& shift) {
  const double left = of_linear_form ? 1.0 : kLeftByCorrection;
  const Eigen::VectorXd modulus = young_moduli(free);
  const double mean_square = modulus.dot(shift.cwiseAbs2()) / std::max(1.0, modulus.sum());
  Eigen::MatrixXd discrepancy = shift * shift.transpose();
  discrepancy.diagonal().array() += modulus.array() * (mean_square - shift.array().square()).max(0.0);
  return left * left * discrepancy;
}

struct MeshError::Studies {
  Model coarse;
  std::unique_ptr<Model> fine;
  std::unique_ptr<ForwardModel> coarse_runs, fine_runs;
  std::vector<std::unique_ptr<ObservationOperator>> operators;

  // The finer model has theta fixed, if one is given.
  Studies(const Model& model, const BasisOptions& basis, const Eigen::VectorXd* theta, const ReuseSources& known)
      : coarse(model.settings(), model), operators(make_observation_operators(coarse)) {
    coarse_runs = make_study_model(coarse, basis, known.own);
    if (known.finer != nullptr) {
      fine = std::make_unique<Model>(coarse.settings(), known.finer->model());
    } else {
      const TetMesh refined = refined_mesh(coarse.mesh(), coarse.settings().mesh);
      fine = std::make_unique<Model>(coarse.settings(), refined,
                                     refine_regions(coarse.body().regions, coarse.mesh(), refined));
    }
    if (theta != nullptr) fine->know(*theta);
    fine_runs = make_study_model(*fine, basis_beside(coarse.mesh(), fine->mesh()), known.finer);
  }

  void prepare(const Question& q) {
    q.drive(coarse);
    q.drive(*fine);
    const std::vector<int> nodes = observed_nodes(operators, q.frames);
    coarse_runs->restrict_output_to(nodes);
    fine_runs->restrict_output_to(nodes);
  }

  // Nodes of the coarse mesh keep their numbers in the finer one, so its run is seen through them.
  std::vector<Prediction> predictions(const ForwardModel& runs, const Question& q, const Eigen::VectorXd& w) const {
    const Eigen::VectorXd theta = coarse.parameters().theta(w);
    const auto run = runs.start(theta, q.start);
    std::vector<Prediction> out;
    for (const Frame& frame : q.frames) {
      q.checkpoint();
      run->advance(frame.time - coarse.sensors().delay(theta));
      const Eigen::VectorXd fine = run->output();
      const Eigen::Index own = coarse.fem().dof_count(), forces = coarse.output_size() - own;
      Eigen::VectorXd output(own + forces);
      output << fine.head(own), fine.tail(forces);
      out.push_back(predict_frame(coarse, operators, frame, theta, output));
    }
    return out;
  }

  // Returns w with the best common factor of all moduli, not far from w. A coarse mesh makes the whole body too stiff, and
  // a body that rings soon has other minima.
  Eigen::VectorXd best_near(const Question& q, const std::vector<Prediction>& truth) const {
    const Eigen::VectorXd stiffer = young_moduli(coarse.parameters().free()).cwiseProduct(q.prior_std);
    const auto cost = [&](const Eigen::VectorXd& x) {
      const std::vector<Prediction> own = predictions(*coarse_runs, q, q.w + x[0] * stiffer);
      double sum = 0.0;
      for (std::size_t k = 0; k < truth.size(); ++k) {
        const Eigen::ArrayXd off = (truth[k].predicted - own[k].predicted).array() / truth[k].sigma.array();
        sum += off.isFinite().select(off, 0.0).square().sum();
      }
      return sum;
    };
    return q.w + scan_around(cost, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1), {0}).best[0] * stiffer;
  }
};

std::vector<Eigen::VectorXd> MeshError::changes(const Question& q, const Eigen::VectorXd& shift) {
  Studies& s = *studies_;
  s.prepare(q);
  const std::vector<Prediction> truth = s.predictions(*s.fine_runs, q, q.w);
  const std::vector<Prediction> own = s.predictions(*s.coarse_runs, q, q.w + shift);
  std::vector<Eigen::VectorXd> out;
  for (std::size_t k = 0; k < truth.size(); ++k) out.emplace_back(truth[k].predicted - own[k].predicted);
  return out;
}

std::string MeshError::why_not(const TetMesh& mesh) {
  if (mesh.node_count() > kMostNodes) return "the mesh has more than " + std::to_string(kMostNodes) + " nodes";
  const double needed = kMemory * mesh.node_count(), available = available_memory();
  if (needed < kMostMemory * available) return "";
  return formatted("it needs %.1f GB of memory, more than half of the %.1f GB that are free", needed, available);
}

std::string MeshError::why_not(const Model& model) {
  if (!model.settings().mesh.discretisation_error) return "the model file asks not to";
  const bool in_full = studied_in_full(model);
  for (const Model::Part& part : model.parts()) {
    if (!in_full && !has_linear_form(part)) return part.label + " has no linear form";
  }
  return why_not(model.mesh());
}

MeshError::MeshError(const Model& model)
    : studies_(std::make_unique<Studies>(model, BasisOptions(), nullptr, ReuseSources())) {}
MeshError::MeshError(const Model& model, const Eigen::VectorXd& theta, const BasisOptions& basis, const ReuseSources& known)
    : studies_(std::make_unique<Studies>(model, basis, &theta, known)) {}
MeshError::~MeshError() = default;

MeshError::Question::Question(const Model& model, std::vector<Frame> seen, Eigen::VectorXd at, Eigen::VectorXd around,
                              Eigen::VectorXd prior)
    : frames(std::move(seen)),
      w(std::move(at)),
      spread(std::move(around)),
      prior_std(std::move(prior)),
      start(model.loads().first_stamp() + model.settings().time.start),
      first_stamp(model.loads().first_stamp()) {
  for (const auto& [topic, course] : model.loads().courses()) courses.emplace(topic, *course);
}

void MeshError::Question::drive(Model& model) const {
  for (const auto& [topic, course] : courses) *model.loads().courses().at(topic) = course;
  model.loads().set_first_stamp(first_stamp);
}

Eigen::VectorXd MeshError::Answer::believed(double mean_square) const {
  const double seen = mean_square - 1.0;
  if (left < kTelling || seen >= left) return shift;
  return std::sqrt(std::max(seen, kTelling) / left) * shift;
}

MeshError::Answer MeshError::study(const Question& q) {
  Studies& s = *studies_;
  s.prepare(q);
  const std::vector<Prediction> truth = s.predictions(*s.fine_runs, q, q.w);
  const auto run_coarse = [&](PosteriorLinearizationFilter& filter, const Eigen::VectorXd& anchor) {
    filter.move_anchor(anchor, q.spread);
    Ensemble ensemble(s.coarse, *s.coarse_runs, s.operators);
    ensemble.restart(filter.sigma_points(), {q.start});
    for (std::size_t k = 0; k < q.frames.size(); ++k) {
      q.checkpoint();
      ensemble.advance(q.frames[k].time);
      const Eigen::MatrixXd rows = ensemble.predict(q.frames[k]).rows;
      const Eigen::VectorXd& sigma = truth[k].sigma;
      filter.update(truth[k].predicted, rows, sigma.cwiseAbs2(), Eigen::VectorXd::Ones(sigma.size()));
    }
  };
  return fit(run_coarse, PosteriorLinearizationFilter(q.w, q.prior_std.cwiseAbs2().asDiagonal()), q, s.best_near(q, truth));
}

}  // namespace tissue_stiffness
