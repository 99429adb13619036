#include "estimation/systematic_error.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "forward/study_model.hpp"

namespace tissue_stiffness {

Eigen::MatrixXd within_prior(const Eigen::MatrixXd& c, const Eigen::VectorXd& prior_std) {
  const Eigen::MatrixXd prior = prior_std.cwiseAbs2().asDiagonal();
  return prior * (prior + c).ldlt().solve(c);
}

SystematicError::SystematicError(const Model& model) : model_(model) {
  refresh();
}

SystematicError::Corrected SystematicError::correct(const Filtered& filtered) const {
  Corrected out{filtered.mean, {}, {}};
  // The mesh shift of a linear form corrects nothing.
  if (studied_in_full(model_)) out.mean -= mesh_shift();
  if (input_shift_.size() > 0 && inputs_believed()) out.mean += input_shift_;
  out.covariance = filtered.covariance + parts_.all;
  Eigen::MatrixXd of_model = Eigen::MatrixXd::Zero(out.mean.size(), out.mean.size());
  // The misfit may lie along what the parameters do, with all rows and frames alike (Kennedy & O'Hagan 2001).
  const double discrepancy = inputs_ ? std::max(test_.discrepancy(), unexplained(filtered.misfit)) : 0.0;
  if (discrepancy > 0.0) {
    of_model =
        within_prior(discrepancy * inputs_->recordings.front().rows * inputs_->from_noise, model_.parameters().prior_std());
  }
  out.covariance += of_model;
  for (Eigen::Index i = 0; i < out.mean.size(); ++i) {
    const double all = out.covariance(i, i);
    out.shares.push_back({filtered.covariance(i, i) / all, parts_.mesh(i, i) / all, parts_.loads(i, i) / all,
                          parts_.constants(i, i) / all, of_model(i, i) / all});
  }
  return out;
}

void SystematicError::refresh() {
  const Eigen::VectorXd prior_std = model_.parameters().prior_std();
  parts_.mesh = mesh_discrepancy(model_, mesh_shift());
  parts_.loads = parts_.constants = Eigen::MatrixXd::Zero(prior_std.size(), prior_std.size());
  if (!inputs_) {  // nothing is known yet of what the inputs' errors do
    if (!model_.settings().exact_inputs) parts_.loads = prior_std.cwiseAbs2().asDiagonal();
  } else {
    test_ = inputs_->recordings.front().test;
    test_.set_numerics(of_mesh());
    parts_.loads = inputs_->from_loads;
    parts_.mesh += inputs_->from_mesh;
    if (input_shift_.size() > 0 && !inputs_believed()) parts_.loads += input_shift_ * input_shift_.transpose();
    parts_.constants = inputs_->from_constants;
  }
  parts_.all = parts_.mesh + parts_.loads + parts_.constants;
}

// Returns the mean square of all frames' misfit beyond noise and mesh, at the present parameters, in noise variances. It
// counts where the misfit does not pass, or has risen since it was tested: then no interval is tighter than the misfit
// allows, whatever the state.
double SystematicError::unexplained(const FilteredMisfit& misfit) const {
  const double tested = inputs_->fitted ? studied_.scale : 1.0;
  const bool passes = inputs_->implausible.empty() && (!inputs_->fitted || test_.passes());
  if (passes && misfit.scale <= kFullSigmas * kFullSigmas * tested && !misfit_has_risen(misfit)) return 0.0;
  return std::max(0.0, misfit.scale - test_.noise_level() - of_mesh());
}

// The sums of squares of all frames and of those that were tested leave that of the frames since then.
bool SystematicError::misfit_has_risen(const FilteredMisfit& misfit) const {
  if (!inputs_ || !inputs_->fitted || !(misfit.rows > studied_.rows)) return false;
  const double rows = misfit.rows - studied_.rows;
  const double since = (misfit.scale * misfit.rows - studied_.scale * studied_.rows) / rows;
  const double passing = kFullSigmas * kFullSigmas + MisfitTest::bound * std::sqrt(2.0 / rows);
  return since > passing * (studied_.scale + of_mesh());
}

bool SystematicError::misfit_has_fallen(const FilteredMisfit& misfit) const {
  return studied_.scale > kFullSigmas * kFullSigmas * (misfit.scale + of_mesh());
}

Eigen::VectorXd SystematicError::mesh_shift() const {
  return mesh_shift_.size() > 0 ? mesh_shift_ : Eigen::VectorXd::Zero(model_.parameters().prior_std().size());
}

double SystematicError::of_mesh() const {
  return kFinerLeaves * mesh_left_.value_or(0.0);
}

bool SystematicError::inputs_believed() const {
  return inputs_->implausible.empty() && test_.passes();
}

bool SystematicError::left_study(const Filtered& filtered) const {
  if (!inputs_ || !inputs_->fitted || input_shift_.size() == 0) return false;
  const Eigen::ArrayXd moved = filtered.mean - runs_at_;
  Eigen::ArrayXd variance = filtered.covariance.diagonal();
  if (!misfit_has_fallen(filtered.misfit)) variance += parts_.all.diagonal().array();
  return (moved.abs() > variance.sqrt()).any();
}

void SystematicError::take_mesh(const MeshError::Answer& answer, double misfit_scale) {
  mesh_shift_ = answer.believed(misfit_scale);
  mesh_left_ = answer.left;
  refresh();
}

void SystematicError::take_inputs(InputStudy::Answer answer, double rows) {
  inputs_ = std::move(answer);
  studied_.rows = rows;
  refresh();
}

void SystematicError::set_runs_at(const Eigen::VectorXd& w, double misfit_scale) {
  runs_at_ = w;
  studied_.scale = misfit_scale;
  input_shift_ = inputs_->w - w;
  refresh();
}

void SystematicError::drop_fit() {
  if (inputs_) inputs_->fitted = false;
  input_shift_.resize(0);
  refresh();
}

void SystematicError::reset() {
  mesh_shift_.resize(0);
  input_shift_.resize(0);
  mesh_left_.reset();
  inputs_.reset();
  test_ = {};
  refresh();
}

}  // namespace tissue_stiffness
