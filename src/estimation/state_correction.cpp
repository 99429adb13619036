#include "tissue_stiffness/estimation/state_correction.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace tissue_stiffness {
namespace {

constexpr double kRegular = 1e-10;  // relative, keeps the covariance's root real

// Gauss-Legendre on [0, 1].
constexpr std::array<double, 3> kNodes{0.1127016653792583, 0.5, 0.8872983346207417};
constexpr std::array<double, 3> kWeights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

}  // namespace

void StateCorrection::advance(const ReducedTrajectory& run, double span) {
  const int modes = static_cast<int>(std::min<Eigen::Index>(most_modes, run.frequencies().size()));
  const ReducedTrajectory::FreeMotion t = run.free_motion(span, modes);
  Eigen::MatrixXd p = Eigen::MatrixXd::Zero(2 * modes, 2 * modes);
  if (root_.size() > 0) {
    Eigen::MatrixXd moved(root_.rows(), root_.cols());
    const auto q = root_.topRows(modes).array(), v = root_.bottomRows(modes).array();
    moved.topRows(modes) = (q.colwise() * t.qq + v.colwise() * t.qv).matrix();
    moved.bottomRows(modes) = (q.colwise() * t.vq + v.colwise() * t.vv).matrix();
    p = moved * moved.transpose();
  }
  for (std::size_t k = 0; k < kNodes.size(); ++k) {
    const ReducedTrajectory::FreeMotion impulse = run.free_motion(kNodes[k] * span, modes);
    const double intensity = kWeights[k] * span * span * force_ * force_;
    for (Eigen::Index i = 0; i < modes; ++i) {
      p(i, i) += intensity * impulse.qv[i] * impulse.qv[i];
      p(modes + i, modes + i) += intensity * impulse.vv[i] * impulse.vv[i];
      p(i, modes + i) += intensity * impulse.qv[i] * impulse.vv[i];
      p(modes + i, i) += intensity * impulse.qv[i] * impulse.vv[i];
    }
  }
  p.diagonal() *= 1.0 + kRegular;
  root_ = p.llt().matrixL();
}

StateCorrection::Whitened StateCorrection::update(const Eigen::VectorXd& measured, const Eigen::MatrixXd& rows,
                                                  const Eigen::VectorXd& precision, const Eigen::MatrixXd& sensitivity) {
  const Eigen::Index modes = sensitivity.cols();
  if (root_.size() == 0) root_ = Eigen::MatrixXd::Zero(2 * modes, 2 * modes);  // the state at the start is known
  Eigen::VectorXd scale = precision.cwiseSqrt();
  for (Eigen::Index r = 0; r < scale.size(); ++r) {
    const bool good = std::isfinite(measured[r]) && rows.row(r).allFinite() && sensitivity.row(r).allFinite();
    if (!good || !std::isfinite(scale[r])) scale[r] = 0.0;
  }
  Whitened out;
  Eigen::MatrixXd h = scale.asDiagonal() * sensitivity, e = -rows;
  e.colwise() += measured;
  e = scale.asDiagonal() * e;
  for (Eigen::Index r = 0; r < scale.size(); ++r) {
    if (scale[r] > 0.0) continue;
    h.row(r).setZero();  // a product with NaN is NaN
    e.row(r).setZero();
  }
  // S = I + A A^T with A = H root; by A^T A = V L V^T everything follows from a 2 modes x 2 modes eigenproblem.
  const Eigen::MatrixXd a = h * root_.topRows(modes);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a.transpose() * a);
  const Eigen::ArrayXd lambda = eigen.eigenvalues().array().max(0.0);
  const Eigen::MatrixXd& v = eigen.eigenvectors();
  const Eigen::MatrixXd seen = v.transpose() * (a.transpose() * e);
  // (1 + l)^-1/2 = 1 + c l: c, without cancellation
  const Eigen::VectorXd shrink = (-1.0 / ((1.0 + lambda).sqrt() * (1.0 + (1.0 + lambda).sqrt()))).matrix();
  const Eigen::VectorXd gain = (1.0 + lambda).inverse().matrix();
  const Eigen::MatrixXd white = e + a * (v * (shrink.asDiagonal() * seen));
  out.step = root_ * (v * (gain.asDiagonal() * seen));
  out.log_determinant = (1.0 + lambda).log().sum();
  root_ = root_ * v * gain.cwiseSqrt().asDiagonal();

  out.rows = -white;  // measured 0 and predictions -e have the innovations as difference
  out.measured = Eigen::VectorXd::Zero(measured.size());
  for (Eigen::Index r = 0; r < scale.size(); ++r) {
    if (scale[r] == 0.0) out.measured[r] = std::numeric_limits<double>::quiet_NaN();
  }
  return out;
}

}  // namespace tissue_stiffness
