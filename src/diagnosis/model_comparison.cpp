#include "tissue_stiffness/diagnosis/model_comparison.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue_stiffness/diagnosis/candidates.hpp"
#include "tissue_stiffness/forward/reduced_trajectory.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSteps[] = {1.0, 4.0};  // squared, over their prior's standard deviation, that are tried
constexpr double kSpread = 0.05;         // prior standard deviations, of the fit that starts where the linearisation leads

double log_determinant(const Eigen::LDLT<Eigen::MatrixXd>& factor) {
  return factor.vectorD().array().max(std::numeric_limits<double>::min()).log().sum();
}

Eigen::MatrixXd lowest_modes(const Fitted& fitted) {
  const Study& study = *fitted.study;
  const auto reduced = study.reduced();
  const double start = study.recording().first_stamp + study.model().settings().time.start;
  const ReducedTrajectory at_rest(*reduced, study.model().theta(fitted.fit.w), start);
  const Eigen::Index count = std::min<Eigen::Index>(kComparison.test_modes, at_rest.frequencies().size());
  return study.rows_along(fitted.fit.w, at_rest.mode_shapes(static_cast<int>(count)), fitted.rows);
}

// The change of every frame, parted into its shares along the lowest modes and the rest, one column each.
Eigen::MatrixXd parted(const Eigen::VectorXd& change, const Eigen::MatrixXd& along,
                       const std::vector<Eigen::Index>& offsets) {
  const Eigen::Index modes = std::min<Eigen::Index>(kComparison.mesh_modes, along.cols());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(change.size(), modes + 1);
  for (std::size_t k = 0; k + 1 < offsets.size(); ++k) {
    const Eigen::Index from = offsets[k], size = offsets[k + 1] - from;
    if (size == 0) continue;
    const Eigen::MatrixXd lowest = along.block(from, 0, size, modes);
    const Eigen::VectorXd own = change.segment(from, size), share = lowest.colPivHouseholderQr().solve(own);
    out.block(from, 0, size, modes) = lowest * share.asDiagonal();
    out.block(from, modes, size, 1) = own - lowest * share;
  }
  return out;
}

// Sum of squares of what such parts have along the modes.
double along_modes(const Eigen::MatrixXd& parts) {
  return parts.cols() > 0 ? parts.leftCols(parts.cols() - 1).rowwise().sum().squaredNorm() : 0.0;
}

// Of a linear model, and the fall of its deviance: all unknowns of the linearisation at the noise as stated.
Eigen::VectorXd most_probable(const Linearisation& model, const Eigen::VectorXd& error, Eigen::Index unknowns,
                              double& deviance) {
  const auto j = model.columns.leftCols(unknowns);
  const Eigen::VectorXd mean = model.prior.head(unknowns);
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(unknowns, unknowns) + j.transpose() * j;
  Eigen::VectorXd u = precision.ldlt().solve(j.transpose() * error + mean);
  deviance = (error - j * u).squaredNorm() + (u - mean).squaredNorm();
  return u;
}

}  // namespace

double log_root_weights(const Study::Rows& rows) {
  return (rows.used.array() > 0.0).select(rows.used.array().log(), 0.0).sum();
}

Linearisation linearise(const Fitted& fitted) {
  const Study& study = *fitted.study;
  const Model& model = study.model();
  const Eigen::VectorXd& w = fitted.fit.w;
  const Eigen::VectorXd prior = model.prior_std();
  const Eigen::MatrixXd own = base_tangents(study, w, fitted.fit.covariance.diagonal().cwiseSqrt(), fitted.rows);
  const Eigen::MatrixXd steps = tangents_of_time_steps(study, w, fitted.rows);
  Linearisation out;
  out.columns.resize(own.rows(), own.cols() + steps.cols());
  out.columns << own * prior.asDiagonal(), steps;
  out.prior = Eigen::VectorXd::Zero(out.columns.cols());
  out.prior.head(w.size()) = (model.prior_mean() - w).cwiseQuotient(prior);
  if (model.nonlinear()) out.mesh_error = kComparison.unknown_mesh * motion_of(fitted.rows).cwiseProduct(fitted.rows.used);
  out.parameters = w.size();
  out.log_root_weights = log_root_weights(fitted.rows);
  return out;
}

Explained explain(const Fitted& fitted, bool far) {
  Explained out{fitted.rows.error, linearise(fitted)};
  const Study& study = *fitted.study;
  const Eigen::Index all = out.linearisation.columns.cols(), own = out.linearisation.parameters;
  if (study.model().nonlinear() || all == own) return out;
  double with = 0.0, without = 0.0;
  most_probable(out.linearisation, out.error, own, without);
  const Eigen::VectorXd u = most_probable(out.linearisation, out.error, all, with);
  const bool linear = without - with > 2.0 * kComparison.worthwhile && u[own] > 0.0;
  if (!linear && !far) return out;
  Fitted joint;
  joint.study =
      std::make_unique<Study>(extend_model(study.model().settings(), entries_of_time_steps(study, fitted.fit.w)), study);
  const Study& stepped_study = *joint.study;
  const Eigen::VectorXd at = stepped_study.extend(study, fitted.fit.w), prior = stepped_study.model().prior_std();
  const Eigen::VectorXd near = kSpread * prior;
  if (linear) joint.fit = stepped_study.quick_fit(at + prior.cwiseProduct(u), near);
  // Long steps lead a body that rings into another minimum, which no tangent shows.
  const std::vector<Eigen::Index> tuning = stepped_study.tuning_shared_with(study);
  for (const double length : kSteps) {
    if (!far) break;
    Eigen::VectorXd start = at;
    start.tail(all - own) = length * prior.tail(all - own);
    const BatchFit fit =
        stepped_study.quick_fit(stepped_study.scan_near(start, tuning).w, stepped_study.spread_beyond(study));
    if (joint.fit.w.size() == 0 || fit.cost < joint.fit.cost) joint.fit = fit;
  }
  joint.rows = stepped_study.rows(joint.fit.w);
  if (joint.rows.error.squaredNorm() > out.error.squaredNorm()) return out;
  return {joint.rows.error, linearise(joint)};
}

ModelComparison::ModelComparison(const Fitted& base, const Eigen::VectorXd& mesh_change)
    : used_((base.rows.used.array() > 0.0).cast<double>()), offsets_(base.rows.offsets), along_(lowest_modes(base)) {
  allow_for_mesh(mesh_change);
  note(base.rows.error);
}

void ModelComparison::allow_for_mesh(const Eigen::VectorXd& change) {
  mesh_ = parted(kComparison.whole_mesh * change, along_, offsets_);
}

void ModelComparison::note(const Eigen::VectorXd& error) {
  const MisfitTest left = test_of(error, 0.0);
  const double memory = left.memory(), variance = left.noise_level() * (1.0 + memory) / (1.0 - memory);
  noise_variance_ = noise_variance_ > 0.0 ? std::min(noise_variance_, variance) : variance;
}

Assessment ModelComparison::assess(const Explained& explained) const {
  const Eigen::VectorXd& error = explained.error;
  const Linearisation& model = explained.linearisation;
  const double s = noise_variance_;
  const Eigen::MatrixXd unknown =
      model.mesh_error.size() > 0 ? parted(model.mesh_error, along_, offsets_) : Eigen::MatrixXd(error.size(), 0);
  Eigen::MatrixXd j(error.size(), model.columns.cols() + mesh_.cols() + unknown.cols());
  j << model.columns, mesh_, unknown;
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(j.cols());
  mean.head(model.prior.size()) = model.prior;
  Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(j.cols(), j.cols());
  precision.noalias() += j.transpose() * j / s;
  const Eigen::LDLT<Eigen::MatrixXd> factor(precision);
  const Eigen::VectorXd seen = j.transpose() * error / s + mean;
  Eigen::VectorXd u = factor.solve(seen);
  // Numerics that are not plausible explain nothing: the parameters have to do without them.
  const Eigen::Index own = model.parameters, rest = j.cols() - own;
  u.tail(rest) = u.tail(rest).cwiseMax(-kComparison.most_numerics).cwiseMin(kComparison.most_numerics);
  u.head(own) =
      precision.topLeftCorner(own, own).ldlt().solve(seen.head(own) - precision.topRightCorner(own, rest) * u.tail(rest));
  const Eigen::VectorXd left = error - j * u;
  Assessment out;
  out.log_likelihood = model.log_root_weights - 0.5 * left.squaredNorm() / s;
  out.log_evidence = out.log_likelihood - 0.5 * ((u - mean).squaredNorm() + log_determinant(factor));
  out.test = test_of(left, static_cast<double>(model.columns.cols()));
  constexpr double part = kComparison.left_of_mesh / kComparison.whole_mesh;
  out.test.set_numerics((part * part * along_modes(mesh_) + along_modes(unknown)) / used_.sum());
  return out;
}

double ModelComparison::log_likelihood(const Study::Rows& rows) const {
  return log_root_weights(rows) - 0.5 * rows.error.squaredNorm() / noise_variance_;
}

MisfitTest ModelComparison::test_of(const Eigen::VectorXd& error, double fitted) const {
  MisfitTest out;
  for (std::size_t k = 0; k + 1 < offsets_.size(); ++k) {
    const Eigen::Index from = offsets_[k], size = offsets_[k + 1] - from;
    if (size == 0) continue;
    const Eigen::Index modes = std::min<Eigen::Index>(along_.cols(), std::max<Eigen::Index>(1, size / 4));
    out.add(error.segment(from, size), used_.segment(from, size), along_.block(from, 0, size, modes));
  }
  out.set_fitted(fitted);
  return out;
}

std::vector<double> posterior(const std::vector<double>& log_weights) {
  const double most = *std::max_element(log_weights.begin(), log_weights.end());
  std::vector<double> out;
  double sum = 0.0;
  for (const double weight : log_weights) {
    out.push_back(std::exp(weight - most));
    sum += out.back();
  }
  for (double& probability : out) probability /= sum;
  return out;
}

Verdict judge(const Comparison& c) {
  const bool given = !c.structured || c.given.probability > 1.0 - kComparison.believed;
  if (given) return c.given.passes ? (c.passes_without_mesh ? Verdict::adequate : Verdict::numerics) : Verdict::unexplained;
  const auto best = std::max_element(c.others.begin(), c.others.end(), [](const Explanation& a, const Explanation& b) {
    return a.probability < b.probability;
  });
  const bool named = best != c.others.end() && best->probability > c.none_of_these;
  return named && best->passes ? Verdict::missing : Verdict::unexplained;
}

}  // namespace tissue_stiffness
