// The unscented filter against the textbook filter, where the two must agree: on linear models.
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <random>

#include "figures.hpp"
#include "filter/unscented_filter.hpp"

namespace tissue_stiffness {
namespace {

// The textbook filter, in Joseph's form.
struct KalmanFilter {
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  double nis = 0.0, log_likelihood = 0.0;

  void predict(const Eigen::MatrixXd& a, const Eigen::MatrixXd& q) {
    mean = a * mean;
    covariance = a * covariance * a.transpose() + q;
  }
  void update(const Eigen::VectorXd& y, const Eigen::MatrixXd& h, const Eigen::MatrixXd& r) {
    const Eigen::MatrixXd s = h * covariance * h.transpose() + r;
    const Eigen::MatrixXd gain = s.llt().solve(h * covariance).transpose();
    const Eigen::VectorXd innovation = y - h * mean;
    nis = innovation.dot(s.llt().solve(innovation));
    const double log_determinant = 2.0 * Eigen::MatrixXd(s.llt().matrixL()).diagonal().array().log().sum();
    log_likelihood = -0.5 * (nis + log_determinant + static_cast<double>(y.size()) * std::log(2.0 * std::acos(-1.0)));
    const Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(mean.size(), mean.size()) - gain * h;
    mean += gain * innovation;
    covariance = rest * covariance * rest.transpose() + gain * r * gain.transpose();
  }
};

const std::vector<UnscentedTuning> kTunings = {{1.0, 2.0, 0.0}, {0.3, 2.0, 0.0}, {2.0, 2.0, 0.0}, {0.5, 0.0, 1.0}};

class RandomModels {
 public:
  Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns) {
    std::normal_distribution<double> normal;
    return Eigen::MatrixXd::NullaryExpr(rows, columns, [&] { return normal(engine_); });
  }
  Eigen::MatrixXd random_covariance(Eigen::Index size) {
    const Eigen::MatrixXd root = random(size, size);
    return root * root.transpose() / static_cast<double>(size) + 0.1 * Eigen::MatrixXd::Identity(size, size);
  }

  /// 60 measurements of l constants.
  void compare_parameters(int l, const UnscentedTuning& tuning) {
    KalmanFilter exact{random(l, 1), random_covariance(l)};
    UnscentedFilter filter(exact.mean, exact.covariance, tuning);
    UnscentedFilter simplex(exact.mean, exact.covariance, SigmaSet::simplex(l));
    for (int step = 0; step < 60; ++step) {
      const int m = 1 + (step * 7) % 13;
      const Eigen::MatrixXd h = random(m, l);
      const Eigen::VectorXd offset = random(m, 1), y = random(m, 1);
      const bool dense = step % 2 == 1;
      const Eigen::VectorXd sigma = random(m, 1).cwiseAbs().array() + 0.5;
      const Eigen::MatrixXd r = dense ? random_covariance(m) : Eigen::MatrixXd(sigma.cwiseAbs2().asDiagonal());
      const Noise noise = dense ? Noise::correlated(r) : Noise::independent(sigma);
      const SigmaModel model = [&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd { return (h * x).colwise() + offset; };
      exact.update(y - offset, h, r);
      const FilterUpdate update = filter.update(y, model(filter.sigma_points()), noise);
      simplex.update(y, model(simplex.sigma_points()), noise);
      nis = std::max(nis, std::abs(update.nis - exact.nis) / (1.0 + exact.nis));
      likelihood = std::max(likelihood, std::abs(update.log_likelihood - exact.log_likelihood) / (1.0 + exact.nis));
    }
    compare(filter, exact, parameters);
    compare(simplex, exact, parameters);
  }

  /// 300 predictions and measurements of a state of l numbers.
  void compare_state(int l, const UnscentedTuning& tuning) {
    const int m = l + 2;
    const Eigen::MatrixXd a = random(l, l) / std::sqrt(2.0 * l), h = random(m, l);
    const Eigen::MatrixXd q_root = 0.3 * random(l, l + 1);
    const Eigen::VectorXd sigma = random(m, 1).cwiseAbs().array() + 0.3;
    const Eigen::MatrixXd r = sigma.cwiseAbs2().asDiagonal();
    KalmanFilter exact{random(l, 1), random_covariance(l)};
    UnscentedFilter filter(exact.mean, exact.covariance, tuning);
    for (int step = 0; step < 300; ++step) {
      const Eigen::VectorXd y = random(m, 1);
      exact.predict(a, q_root * q_root.transpose());
      exact.update(y, h, r);
      filter.predict([&](const Eigen::MatrixXd& x) -> Eigen::MatrixXd { return a * x; }, q_root);
      filter.update(y, h * filter.sigma_points(), Noise::independent(sigma));
      compare(filter, exact, state);
    }
  }

  double parameters = 0.0, state = 0.0, nis = 0.0, likelihood = 0.0;  ///< worst differences

 private:
  static void compare(const UnscentedFilter& filter, const KalmanFilter& exact, double& worst) {
    const double mean = (filter.mean() - exact.mean).cwiseAbs().maxCoeff();
    const double covariance = (filter.covariance() - exact.covariance).cwiseAbs().maxCoeff();
    worst = std::max({worst, mean, covariance});
    if (!std::isfinite(mean + covariance)) worst = INFINITY;
  }

  std::mt19937 engine_{7};
};

}  // namespace

std::vector<Figure> kalman_figures() {
  RandomModels models;
  for (const UnscentedTuning& tuning : kTunings) {
    for (const int l : {1, 2, 5, 9}) models.compare_parameters(l, tuning);
    for (const int l : {1, 3, 8}) models.compare_state(l, tuning);
  }
  return {{"unscented against Kalman, mean and covariance of parameters", models.parameters, 0.0, 1e-12},
          {"unscented against Kalman, mean and covariance of a state", models.state, 0.0, 1e-12},
          {"unscented against Kalman, NIS", models.nis, 0.0, 1e-11},
          {"unscented against Kalman, log-likelihood", models.likelihood, 0.0, 1e-10}};
}

}  // namespace tissue_stiffness
