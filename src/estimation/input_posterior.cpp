#include "estimation/input_posterior.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 6;
constexpr int kMostCuts = 3;
constexpr double kSettled = 0.1;      // posterior standard deviations
constexpr int kMostSteps = 4;         // of Gauss-Newton, with the place on the line held
constexpr int kMostMarched = 14;      // points of the line to either side
constexpr double kGrowth = 1.3;       // ratio of successive distances on the line
constexpr double kImprobable = 16.0;  // -2 log posterior above the least
constexpr int kMostImprobable = 3;    // such points in a row end the line: one may be a wall of a comb
constexpr double kNegligible = 9.0;   // -2 log posterior above the least, where the grid is not refined
constexpr double kResolved = 2.0;     // local standard deviations between two points
constexpr std::size_t kMostPoints = 60;
constexpr double kLinear = 3.0;          // fall of -2 log posterior that the linear form predicts well
constexpr double kFurthest = 3.0;        // prior standard deviations
constexpr double kMostTolerated = 1.96;  // standard deviations of a constant: its 95 % interval

}  // namespace

InputPosterior::InputPosterior(Rows rows, const Eigen::VectorXd& prior_mean, const Eigen::VectorXd& prior_std,
                               const Eigen::VectorXd& nuisance_std)
    : rows_(std::move(rows)),
      p_(prior_mean.size()),
      size_(p_ + nuisance_std.size()),
      prior_mean_(prior_mean),
      prior_std_(prior_std),
      nuisance_std_(nuisance_std) {}

void InputPosterior::set_nuisance_std(Eigen::Index first, Eigen::Index count, double std) {
  nuisance_std_.segment(first - p_, count).setConstant(std);
}

double InputPosterior::widest_nuisance_std(Eigen::Index first, Eigen::Index count) const {
  return nuisance_std_.segment(first - p_, count).maxCoeff();
}

Eigen::VectorXd InputPosterior::prior_information() const {
  Eigen::VectorXd out(size_);
  out << prior_std_.cwiseAbs2().cwiseInverse(), nuisance_std_.cwiseAbs2().cwiseInverse();
  return out;
}

Eigen::VectorXd InputPosterior::from_prior(const Eigen::VectorXd& z) const {
  Eigen::VectorXd out = -z;
  out.head(p_) += prior_mean_;
  return out;
}

void InputPosterior::set_temperature(std::size_t recording, double temperature) {
  temperatures_.resize(std::max(temperatures_.size(), recording + 1), 1.0);
  temperatures_[recording] = temperature;
}

double InputPosterior::temperature(std::size_t recording) const {
  return recording < temperatures_.size() ? temperatures_[recording] : 1.0;
}

double InputPosterior::cost(const Fit& fit, const Eigen::VectorXd& scales) const {
  double sum = from_prior(fit.z).cwiseAbs2().dot(prior_information());
  for (std::size_t i = 0; i < fit.normal.size(); ++i) sum += fit.normal[i].cost / scales[static_cast<Eigen::Index>(i)];
  return sum;
}

Eigen::VectorXd InputPosterior::scales(const Equations& normal) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(normal.size()));
  for (std::size_t i = 0; i < normal.size(); ++i) {
    out[static_cast<Eigen::Index>(i)] = temperature(i) * std::max(1.0, normal[i].cost / std::max(1.0, normal[i].rows));
  }
  return out;
}

NormalEquations InputPosterior::sum(const Equations& normal, const Eigen::VectorXd& scales) const {
  NormalEquations out = normal.front();
  out.repeat(1.0 / scales[0]);
  for (std::size_t i = 1; i < normal.size(); ++i) out.add(normal[i], 1.0 / scales[static_cast<Eigen::Index>(i)]);
  return out;
}

Eigen::MatrixXd InputPosterior::information(const Equations& normal) const {
  Eigen::MatrixXd out = sum(normal, scales(normal)).information;
  out.diagonal() += prior_information();
  return out;
}

Eigen::MatrixXd InputPosterior::covariance(const Equations& normal) const {
  return information(normal).ldlt().solve(Eigen::MatrixXd::Identity(size_, size_));
}

// At the mode the gradient of z vanishes, so that c solves the Schur complement of z.
InputPosterior::Tolerated InputPosterior::tolerated(const Equations& normal) const {
  const NormalEquations all = sum(normal, scales(normal));
  const Eigen::MatrixXd move = information(normal).ldlt().solve(all.constants);
  Eigen::MatrixXd left = all.constants_information - all.constants.transpose() * move;
  left.diagonal().array() += 1.0 / kTails;
  const double most = kMostTolerated * std::sqrt(kTails);
  const Eigen::VectorXd c = left.ldlt().solve(all.constants_gradient).cwiseMax(-most).cwiseMin(most);
  return {-move * c, c};
}

double InputPosterior::learnt(const Eigen::MatrixXd& covariance, Eigen::Index i) const {
  return std::max(0.0, 1.0 - covariance(i, i) / std::pow(nuisance_std(i), 2));
}

InputPosterior::Fit InputPosterior::at(const Eigen::VectorXd& w) {
  Eigen::VectorXd z = Eigen::VectorXd::Zero(size_);
  z.head(p_) = w;
  return {z, rows_(z, Constants::varied)};
}

InputPosterior::Fit InputPosterior::mode(const Eigen::VectorXd& w) {
  Fit fit = at(w);
  bool moved = false;
  for (int k = 0; k < kMostIterations && improve(fit); ++k) moved = true;
  if (moved) fit.normal = rows_(fit.z, Constants::varied);
  return fit;
}

// Makes one Gauss-Newton step, shortened while the cost does not fall. Returns false at the end.
bool InputPosterior::improve(Fit& fit) {
  const Eigen::VectorXd s = scales(fit.normal);
  const Eigen::MatrixXd inverse_covariance = information(fit.normal);
  const Eigen::VectorXd pull = sum(fit.normal, s).gradient + prior_information().cwiseProduct(from_prior(fit.z));
  const Eigen::VectorXd step = inverse_covariance.ldlt().solve(pull);
  if (step.dot(pull) < kSettled * kSettled) return false;
  double share = std::min(1.0, (prior_std_.array() / step.head(p_).array().abs().max(1e-300)).minCoeff());
  for (int cut = 0; cut < kMostCuts; ++cut, share *= 0.3) {
    const Eigen::VectorXd z = fit.z + share * step;
    Fit next{z, rows_(z, Constants::held)};
    if (!(cost(next, s) < cost(fit, s))) continue;
    fit = std::move(next);
    return true;
  }
  return false;
}

InputPosterior::Line InputPosterior::line(const Fit& mode) const {
  const Eigen::MatrixXd own = covariance(mode.normal).topLeftCorner(p_, p_);
  const Eigen::VectorXd per_prior = prior_std_.cwiseInverse();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(per_prior.asDiagonal() * own * per_prior.asDiagonal());
  const double widest = std::sqrt(axes.eigenvalues()[p_ - 1]);
  Line out;
  out.direction = widest * prior_std_.cwiseProduct(axes.eigenvectors().col(p_ - 1));
  out.dual = own.ldlt().solve(out.direction);
  out.scales = scales(mode.normal);
  out.furthest = kFurthest / widest;
  return out;
}

// Runs Gauss-Newton on all of z with its place on the line held.
InputPosterior::Point InputPosterior::most_probable(const Line& line, double along, Eigen::VectorXd z) {
  Point out{along, 0.0, 0.0, {}};
  for (int k = 0; k < kMostSteps; ++k) {
    const Fit fit{z, rows_(z, Constants::held)};
    const NormalEquations normal = sum(fit.normal, line.scales);
    Eigen::MatrixXd inverse_covariance = normal.information;
    inverse_covariance.diagonal() += prior_information();
    const Eigen::VectorXd pull = normal.gradient + prior_information().cwiseProduct(from_prior(z));
    // The step minimises over the plane dual . step = 0.
    Eigen::MatrixXd sides(z.size(), 2);
    sides.col(0) = pull;
    sides.col(1).setZero();
    sides.col(1).head(p_) = line.dual;
    const Eigen::MatrixXd solved = inverse_covariance.ldlt().solve(sides);
    const double compliance = sides.col(1).dot(solved.col(1));
    const Eigen::VectorXd step = solved.col(0) - solved.col(1) * (sides.col(1).dot(solved.col(0)) / compliance);
    const double gain = pull.dot(step);
    out.cost = cost(fit, line.scales) - gain;
    out.deviation = std::sqrt(compliance);
    z += step;
    if (gain < kLinear) break;
  }
  out.z = std::move(z);
  return out;
}

// Marches outwards from the mode, in steps that grow. Each point starts where the last two lead.
void InputPosterior::march(const Line& line, double side, Points& points) {
  Point last = points.front(), before = last;
  double step = 1.0, least = last.cost;
  int improbable = 0;
  for (int k = 0; k < kMostMarched && improbable < kMostImprobable; ++k, step *= kGrowth) {
    const double along = last.along + side * step;
    if (std::abs(along) > line.furthest) return;
    Eigen::VectorXd z = last.z;
    if (before.along != last.along) z += (along - last.along) / (last.along - before.along) * (last.z - before.z);
    z.head(p_) += line.direction * (along - last.along) - line.direction * line.dual.dot(z.head(p_) - last.z.head(p_));
    before = std::move(last);
    last = most_probable(line, along, std::move(z));
    points.push_back(last);
    least = std::min(least, last.cost);
    improbable = last.cost > least + kImprobable ? improbable + 1 : 0;
  }
}

// Halves the gaps that are wider than the narrowest maximum's deviation, where the posterior may have mass.
void InputPosterior::refine(const Line& line, Points& points) {
  while (points.size() < kMostPoints) {
    double least = points.front().cost, finest = points.front().deviation;
    for (const Point& point : points) {
      least = std::min(least, point.cost);
      finest = std::min(finest, point.deviation);
    }
    std::size_t widest = 0;
    double most = kResolved;
    for (std::size_t k = 0; k + 1 < points.size(); ++k) {
      const Point &a = points[k], &b = points[k + 1];
      const double gap = (b.along - a.along) / finest;
      const double bowl = std::min(a.cost, b.cost) - 0.25 * gap * gap;  // least cost that the curvature allows between
      if (bowl > least + kNegligible) continue;
      if (gap > most) widest = k, most = gap;
    }
    if (most == kResolved) return;
    const Point &a = points[widest], &b = points[widest + 1];
    Point middle = most_probable(line, 0.5 * (a.along + b.along), 0.5 * (a.z + b.z));
    points.insert(points.begin() + static_cast<std::ptrdiff_t>(widest) + 1, std::move(middle));
  }
}

InputPosterior::Moments InputPosterior::integrate(const Fit& mode) {
  const Line along = line(mode);
  Points points{{0.0, cost(mode, along.scales), 1.0, mode.z}};
  for (const double side : {1.0, -1.0}) march(along, side, points);
  std::sort(points.begin(), points.end(), [](const Point& a, const Point& b) { return a.along < b.along; });
  refine(along, points);

  double least = points.front().cost;
  for (const Point& point : points) least = std::min(least, point.cost);
  const std::size_t last = points.size() - 1;
  Eigen::VectorXd weights(static_cast<Eigen::Index>(points.size()));  // trapezoidal rule
  for (std::size_t k = 0; k <= last; ++k) {
    const double width = points[std::min(k + 1, last)].along - points[k - std::min<std::size_t>(k, 1)].along;
    weights[static_cast<Eigen::Index>(k)] = width * std::exp(0.5 * (least - points[k].cost));
  }
  weights /= weights.sum();
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(size_);
  for (std::size_t k = 0; k <= last; ++k) mean += weights[static_cast<Eigen::Index>(k)] * points[k].z;
  Eigen::MatrixXd spread = Eigen::MatrixXd::Zero(size_, size_);
  for (std::size_t k = 0; k <= last; ++k) {
    const Eigen::VectorXd apart = points[k].z - mean;
    spread += weights[static_cast<Eigen::Index>(k)] * apart * apart.transpose();
  }
  // By the law of total covariance the linear form holds at a held place on the line, and the place itself has the spread.
  Moments out{{mean, rows_(mean, Constants::varied)}, Eigen::MatrixXd::Zero(size_, size_)};
  const Eigen::VectorXd drift = covariance(out.mean.normal).leftCols(p_) * along.dual;
  const double linear = along.dual.dot(drift.head(p_));
  if (along.dual.dot(spread.topLeftCorner(p_, p_) * along.dual) > linear) {
    out.beyond_linear = spread - drift * drift.transpose() / linear;
  }
  return out;
}

}  // namespace tissue_stiffness
