#include "forward/hyper_reduced_model.hpp"

#include <cmath>
#include <utility>

#include "forward/hyper_reduced_trajectory.hpp"
#include "forward/project_matrix.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTolerance = 3e-7;  // of the body's size, root mean square over the body
constexpr double kStep = 0.02;       // likewise: displacements at which a follower's polynomial is found

// Runs whose displacements are recovered together.
class HyperReducedTrajectories : public SeparateTrajectories {
 public:
  HyperReducedTrajectories(const HyperReducedModel& reduced, std::vector<std::unique_ptr<Trajectory>> runs)
      : SeparateTrajectories(std::move(runs)), reduced_(reduced) {}

  void outputs(Eigen::MatrixXd& out) const override {
    Eigen::MatrixXd q(run(0).coordinates().size(), static_cast<Eigen::Index>(size()));
    for (std::size_t i = 0; i < size(); ++i) q.col(static_cast<Eigen::Index>(i)) = run(i).coordinates();
    reduced_.displacements(q, out);
  }
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const override {
    Eigen::VectorXd q = Eigen::VectorXd::Zero(run(0).coordinates().size());
    for (std::size_t i = 0; i < size(); ++i) q += weights[static_cast<Eigen::Index>(i)] * run(i).coordinates();
    reduced_.recover(q, sum);
  }

 private:
  const HyperReducedTrajectory& run(std::size_t i) const { return static_cast<const HyperReducedTrajectory&>(*runs_[i]); }

  const HyperReducedModel& reduced_;
};

}  // namespace

HyperReducedModel::HyperReducedModel(const Model& model, FullMotions motions, const HyperOptions& options)
    : model_(model), options_(options), motions_(std::move(motions)) {
  require_form();
  basis_ = choose_hyper_basis(model, motions_, options_);
  project_motion();
  project_parts();
}

HyperReducedModel::HyperReducedModel(const Model& model, const HyperReducedModel& relative)
    : model_(model), options_(relative.options_), motions_(relative.motions_), basis_(relative.basis_) {
  require_form();
  motions_.thetas.assign(motions_.thetas.size(), model.prior_theta());
  project_motion();
  project_parts();
}

void HyperReducedModel::require_form() const {
  if (const std::string why = why_not_hyper_reduced(model_); !why.empty()) {
    throw InputError(model_.settings().name, why, "a model of finite strain with a form at sampled points");
  }
}

void HyperReducedModel::project_motion() {
  const Eigen::MatrixX3d unit = unit_motion(basis_.vectors.rows());
  SparseMatrix mass = model_.mass(motions_.thetas.front());
  Eigen::MatrixX3d free = unit;
  for (Eigen::Index i = 0; i < free.rows(); ++i) {
    if (model_.fixed()[static_cast<std::size_t>(i)] != 0) free.row(i).setZero();
  }
  unit_velocity_ = basis_.vectors.transpose() * (mass * free);
  const double whole = (unit.col(0).transpose() * (mass * unit.col(0))).value();
  size_ = body_size(model_.mesh().nodes) * std::sqrt(whole);
}

void HyperReducedModel::project_parts() {
  const Eigen::MatrixXd& v = basis_.vectors;
  const Eigen::MatrixX3d unit = unit_motion(v.rows());
  for (const ModelPart& part : model_.parts()) {
    Projected own;
    for (const MatrixTerm& term : part.terms.mass) {
      own.mass.push_back(project_matrix(*term.matrix, v));
      own.weight.emplace_back(v.transpose() * (*term.matrix * unit));
    }
    for (const MatrixTerm& term : part.terms.stiffness) own.stiffness.push_back(project_matrix(*term.matrix, v));
    for (const LoadTerm& term : part.terms.loads) own.loads.emplace_back(v.transpose() * term.pattern);
    const FiniteStrainForm* form = part.effect->finite_strain();
    if (form != nullptr && form->follower_load() != nullptr) own.follower = project(*form->follower_load());
    projected_.push_back(std::move(own));
  }
}

QuadraticForce HyperReducedModel::project(const FollowerLoad& load) const {
  const auto force = [&](const Eigen::VectorXd& q) -> Eigen::VectorXd {
    Eigen::VectorXd u(basis_.vectors.rows()), nodal = Eigen::VectorXd::Zero(u.size());
    recover(q, u);
    load.add_unit_force(u, nodal);
    return basis_.vectors.transpose() * nodal;
  };
  return {force, Eigen::VectorXd::Constant(basis_.vectors.cols(), kStep * size_)};
}

double HyperReducedModel::tolerance() const {
  return kTolerance * size_;
}

std::unique_ptr<Trajectory> HyperReducedModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<HyperReducedTrajectory>(*this, theta, start);
}

std::unique_ptr<Trajectories> HyperReducedModel::start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  return std::make_unique<HyperReducedTrajectories>(*this, start_each(thetas, start));
}

std::unique_ptr<Trajectory> HyperReducedModel::resume(const Eigen::VectorXd& theta, const Trajectory& from) const {
  return std::make_unique<HyperReducedTrajectory>(*this, theta, dynamic_cast<const HyperReducedTrajectory&>(from));
}

std::unique_ptr<Trajectories> HyperReducedModel::resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                                            const Trajectory& from) const {
  return std::make_unique<HyperReducedTrajectories>(*this, resume_each(thetas, from));
}

void HyperReducedModel::recover(const Eigen::VectorXd& coordinates, Eigen::Ref<Eigen::VectorXd> displacement) const {
  multiply_tall(basis_.vectors, coordinates, displacement);
}

int HyperReducedModel::steps(double span) const {
  const double step = options_.full.step;
  return step > 0.0 ? static_cast<int>(std::ceil(span / step * (1.0 - 1e-9))) : options_.full.steps_per_frame;
}

std::string HyperReducedModel::description() const {
  return "hyper-reduced: " + std::to_string(basis_.vectors.cols()) + " vectors for " +
         std::to_string(basis_.vectors.rows()) + " degrees of freedom, " + std::to_string(basis_.points.size()) + " of " +
         std::to_string(model_.fem().element_count() * model_.fem().points_per_element()) + " quadrature points, " +
         std::to_string(options_.full.steps_per_frame) + " steps a frame";
}

}  // namespace tissue_stiffness
