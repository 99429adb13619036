#include "filter/posterior_linearization_filter.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

double scale_of(double data_cost, double rows) {
  return rows > 0.0 ? std::max(1.0, data_cost / rows) : 1.0;
}

}  // namespace

PosteriorLinearizationFilter::PosteriorLinearizationFilter(const Eigen::VectorXd& mean, const Eigen::MatrixXd& covariance)
    : prior_mean_(mean), prior_information_(covariance.ldlt().solve(Eigen::MatrixXd::Identity(mean.size(), mean.size()))) {
  move_anchor(mean, covariance.diagonal().cwiseSqrt());
}

void PosteriorLinearizationFilter::move_anchor(const Eigen::VectorXd& anchor, const Eigen::VectorXd& spread) {
  const Eigen::Index p = anchor.size();
  anchor_ = anchor;
  spread_ = spread;
  points_ = anchor.replicate(1, 2 * p + 1);
  for (Eigen::Index i = 0; i < p; ++i) {
    points_(i, 1 + i) += spread[i];
    points_(i, 1 + p + i) -= spread[i];
  }
  information_ = Eigen::MatrixXd::Zero(p, p);
  gradient_ = Eigen::VectorXd::Zero(p);
  scores_.clear();
  data_cost_ = bend_cost_ = 0.0;
  rows_ = 0;
}

Eigen::MatrixXd PosteriorLinearizationFilter::slopes(const Eigen::MatrixXd& y) const {
  const Eigen::Index p = anchor_.size();
  return (y.middleCols(1, p) - y.rightCols(p)) * (0.5 * spread_.cwiseInverse()).asDiagonal();
}

Eigen::VectorXd PosteriorLinearizationFilter::predict(const Eigen::MatrixXd& predictions, const Eigen::VectorXd& w) const {
  return predictions.col(0) + slopes(predictions) * (w - anchor_);
}

PosteriorLinearizationFilter::Innovation PosteriorLinearizationFilter::update(const Eigen::VectorXd& y,
                                                                              const Eigen::MatrixXd& predictions,
                                                                              const Eigen::VectorXd& variance,
                                                                              const Eigen::VectorXd& weight) {
  const Eigen::Index p = anchor_.size();
  Eigen::MatrixXd h = slopes(predictions);
  Eigen::VectorXd e = y - predictions.col(0);
  const Eigen::VectorXd step = mean() - anchor_;
  // The deviation from a straight line through the sigma points is noise for the linearised model.
  Eigen::VectorXd curvature = Eigen::VectorXd::Zero(y.size());
  for (Eigen::Index i = 0; i < p; ++i) {
    const Eigen::VectorXd bend = 0.5 * (predictions.col(1 + i) + predictions.col(1 + p + i)) - predictions.col(0);
    curvature += bend.cwiseAbs2();
  }
  Eigen::VectorXd precision(y.size());
  Innovation out;
  for (Eigen::Index r = 0; r < y.size(); ++r) {
    const bool good = std::isfinite(e[r]) && h.row(r).allFinite() && std::isfinite(curvature[r]) && variance[r] > 0.0 &&
                      std::isfinite(variance[r]);
    precision[r] = good ? weight[r] / (variance[r] + curvature[r]) : 0.0;
    if (good) {
      out.cost += weight[r] * e[r] * e[r] / variance[r];
      bend_cost_ += weight[r] * curvature[r] / variance[r];
      ++out.dof;
    } else {
      e[r] = 0.0;
      h.row(r).setZero();
    }
  }
  const Eigen::MatrixXd weighted = precision.asDiagonal() * h;
  const Eigen::MatrixXd added = h.transpose() * weighted;
  const Eigen::VectorXd innovation = e - h * step;
  // This is e^T (H P H^T + R)^-1 e by Woodbury's identity, which inverts only p x p.
  const Eigen::MatrixXd before = misfit_scale() * total_information();
  const Eigen::VectorXd projected = weighted.transpose() * innovation;
  out.nis = innovation.dot(precision.cwiseProduct(innovation)) - projected.dot((before + added).ldlt().solve(projected));

  information_ += added;
  const Eigen::VectorXd pull = weighted.transpose() * e;
  gradient_ += pull;
  scores_.add(added, pull);
  data_cost_ += out.cost;
  rows_ += out.dof;
  return out;
}

double PosteriorLinearizationFilter::misfit_scale() const {
  return scale_of(data_cost_, rows_);
}

Eigen::MatrixXd PosteriorLinearizationFilter::total_information() const {
  return information_ / misfit_scale() + prior_information_;
}

Eigen::VectorXd PosteriorLinearizationFilter::mean() const {
  return mean(0.0);
}

Eigen::VectorXd PosteriorLinearizationFilter::mean(double damping) const {
  Eigen::MatrixXd information = total_information();
  information.diagonal() *= 1.0 + damping;
  return anchor_ + information.ldlt().solve(gradient_ / misfit_scale() + prior_information_ * (prior_mean_ - anchor_));
}

Eigen::MatrixXd PosteriorLinearizationFilter::covariance() const {
  const Eigen::Index p = anchor_.size();
  return total_information().ldlt().solve(Eigen::MatrixXd::Identity(p, p));
}

Eigen::MatrixXd PosteriorLinearizationFilter::robust_covariance() const {
  const double scale = misfit_scale();
  return scores_.widened(covariance(), scores_.variance(mean() - anchor_) / (scale * scale));
}

double PosteriorLinearizationFilter::cost_at(const Eigen::VectorXd& w, double data_cost, double rows) const {
  const Eigen::VectorXd step = w - prior_mean_;
  return data_cost + scale_of(data_cost, rows) * step.dot(prior_information_ * step);
}

bool PosteriorLinearizationFilter::stale(double far, double wide, const Eigen::VectorXd& floor) const {
  const Eigen::ArrayXd step = (mean() - anchor_).array().abs();
  const Eigen::ArrayXd std = covariance().diagonal().array().sqrt();
  return (step > far * spread_.array()).any() || (spread_.array() > (wide * std).max(floor.array())).any();
}

}  // namespace tissue_stiffness
