#include "forward/load_error_response.hpp"

#include <tbb/parallel_for.h>

#include <cmath>

namespace tissue_stiffness {
namespace {

constexpr double kLoadStep = 0.008;  // [s] at most between two values of a load

}  // namespace

LoadErrorResponse::LoadErrorResponse(const ReducedModel& reduced, const Eigen::VectorXd& theta, double start,
                                     std::shared_ptr<const Course> course, const LoadErrorBasis& basis)
    : reduced_(reduced),
      course_(std::move(course)),
      basis_(basis),
      time_(start),
      modes_(reduced.modes(theta)),
      patterns_(Eigen::MatrixXd::Zero(modes_->square.size(), basis.components())),
      reaction_rows_(reduced.reaction_rows(theta, *modes_)),
      stiffness_damping_(reduced.model().stiffness_damping(theta)),
      step_(modes_->square, modes_->damping(reduced.model().mass_damping(theta), stiffness_damping_),
            reduced.model().relaxations(theta)) {
  const auto& parts = reduced.model().parts();
  const double factor = reduced.model().load_factor(theta);
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const Eigen::VectorXd own = parts[p].parameters(theta);
    for (std::size_t i = 0; i < parts[p].terms.loads.size(); ++i) {
      const LoadTerm& term = parts[p].terms.loads[i];
      if (term.course != course_ || term.component >= basis.components()) continue;
      const double c = (term.prescribed ? 1.0 : factor) * term.coefficient(own);
      patterns_.col(term.component) += c * (modes_->shapes.transpose() * reduced.load(p, i, own));
      prescribed_ = prescribed_ || term.prescribed;
    }
  }
  states_.assign(static_cast<std::size_t>(basis.size()), Eigen::MatrixXd::Zero(modes_->square.size(), step_.states()));
  forces_ = modal_forces(start);
}

Eigen::MatrixXd LoadErrorResponse::errors(double time) const {
  const auto measured = [this](double t) {
    Eigen::VectorXd load(basis_.components());
    for (int i = 0; i < load.size(); ++i) load[i] = course_->measured(t, i);
    return load;
  };
  return basis_.value(measured, time);
}

void LoadErrorResponse::advance(double time) {
  const double span = time - time_;
  if (!(span > 0.0)) return;
  const int steps = static_cast<int>(std::ceil(span / kLoadStep));
  const double start = time_, step = span / steps;
  for (int k = 1; k <= steps; ++k) {
    time_ = k == steps ? time : start + step * k;
    const Eigen::MatrixXd next = modal_forces(time_);
    for (Eigen::Index j = 0; j < next.cols(); ++j) {
      Eigen::MatrixXd& state = states_[static_cast<std::size_t>(j)];
      if (state.isZero(0.0) && forces_.col(j).isZero(0.0) && next.col(j).isZero(0.0)) continue;  // it has not begun
      step_.advance(step, forces_.col(j), next.col(j), state);
    }
    forces_ = next;
  }
}

Eigen::MatrixXd LoadErrorResponse::amplitudes() const {
  Eigen::MatrixXd modal(modes_->square.size(), static_cast<Eigen::Index>(states_.size()));
  for (std::size_t j = 0; j < states_.size(); ++j) modal.col(static_cast<Eigen::Index>(j)) = states_[j].col(0);
  return modal;
}

// Modes that are faster than the steps follow the load without inertia (see ReducedTrajectory).
Eigen::MatrixXd LoadErrorResponse::further_reactions() const {
  const Eigen::MatrixXd &lift = reaction_rows_.lift, &elastic = reaction_rows_.elastic;
  Eigen::MatrixXd out(lift.cols(), static_cast<Eigen::Index>(states_.size()));
  if (out.rows() == 0) return out;
  const Eigen::VectorXd& square = modes_->square;
  const Eigen::Array<bool, Eigen::Dynamic, 1> fast = square.array() * kLoadStep * kLoadStep > 1.0;
  for (std::size_t j = 0; j < states_.size(); ++j) {
    const auto column = static_cast<Eigen::Index>(j);
    const Eigen::MatrixXd& state = states_[j];
    const Eigen::VectorXd stretched =
        fast.select(forces_.col(column).cwiseQuotient(square), step_.stretch(state, stiffness_damping_));
    Eigen::VectorXd beyond = fast.select(0.0, forces_.col(column) - square.cwiseProduct(stretched));
    if (!prescribed_) beyond -= forces_.col(column);
    out.col(column) = lift.transpose() * beyond + elastic.transpose() * (stretched - state.col(0));
  }
  return out;
}

}  // namespace tissue_stiffness
