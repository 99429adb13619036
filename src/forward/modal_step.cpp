#include "forward/modal_step.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <string>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSameStep = 1e-11;   // [s]
constexpr double kLeastAngle2 = 0.1;  // (omega h)^2 below which the closed form would lose digits
constexpr double kMostDamping = 0.9;  // damping ratio, squared: near one it would, too

constexpr int kMostBranches = 6;
constexpr double kMostCondition = 1e4;  // of a mode's eigenvectors: beyond it the spectrum would lose digits
constexpr double kSmall = 0.5;          // |x| below which the integrals are summed as series
constexpr int kTerms = 14;              // of these series

// Returns the integrals of exp(x (1 - s)) and of s exp(x (1 - s)) over s from 0 to 1.
std::pair<std::complex<double>, std::complex<double>> integrals(const std::complex<double>& x,
                                                                const std::complex<double>& exponential) {
  if (std::abs(x) > kSmall) return {(exponential - 1.0) / x, (exponential - 1.0 - x) / (x * x)};
  std::complex<double> once = 0.0, twice = 0.0, power = 1.0;
  double factorial = 1.0;
  for (int k = 0; k < kTerms; ++k, power *= x) {
    factorial *= k + 1;
    once += power / factorial;
    twice += power / (factorial * (k + 2));
  }
  return {once, twice};
}

// Augmented exponential of a step h of q'' + d q' + w q = f without branches. The rows are q, q', the columns q, q', f and
// its increment.
using Oscillation = Eigen::Matrix<double, 2, 4>;

// The closed form is Clough & Penzien 1993, eq. (2-49), and its integrals over the step.
bool oscillates(double w, double d, double h) {
  return w * h * h > kLeastAngle2 && d * d < 4.0 * kMostDamping * w;
}
Oscillation oscillation(double w, double d, double h) {
  const double omega = std::sqrt(w - 0.25 * d * d), fading = std::exp(-0.5 * d * h);
  const double s = fading * std::sin(omega * h) / omega, c = fading * std::cos(omega * h);
  const double y = c + 0.5 * d * s;             // q after a unit q
  const double once = (1.0 - y) / w;            // q after a unit force
  const double twice = (h - s - d * once) / w;  // and after one that grows as the time
  Oscillation e;
  e << y, s, once, twice / h, -w * s, c - 0.5 * d * s, s, once / h;
  return e;
}

}  // namespace

ModalStep::ModalStep(Eigen::VectorXd square, Eigen::VectorXd damping, std::vector<Relaxation> branches)
    : square_(std::move(square)), damping_(std::move(damping)), branches_(std::move(branches)) {
  if (branches_.size() > kMostBranches) {
    throw InputError("viscoelasticity", std::to_string(branches_.size()) + " branches",
                     "at most " + std::to_string(kMostBranches));
  }
  transition_.assign(static_cast<std::size_t>(states() * (states() + 2)), Eigen::ArrayXd(square_.size()));
  spectra_.resize(static_cast<std::size_t>(square_.size()));
}

// Returns the matrix A of (q, q', z)' = A (q, q', z) + (0, f, 0).
Eigen::MatrixXd ModalStep::system(Eigen::Index mode) const {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(states(), states());
  a(0, 1) = 1.0;
  a(1, 0) = -square_[mode];
  a(1, 1) = -damping_[mode];
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const auto z = static_cast<Eigen::Index>(2 + b);
    a(1, 0) -= branches_[b].modulus * square_[mode];
    a(1, z) = branches_[b].modulus * square_[mode];
    a(z, 0) = 1.0 / branches_[b].time_constant;
    a(z, z) = -a(z, 0);
  }
  return a;
}

// Returns the spectrum of a system with that many states; a known number of them is faster.
template <int count>
ModalStep::Spectrum ModalStep::spectrum_of(Eigen::Matrix<double, count, count> a) {
  // The velocity is counted in displacements times the mode's frequency, so that the eigenvectors' entries are alike.
  const double frequency = std::sqrt(std::max(-a(1, 0), a(1, 1) * a(1, 1)));
  if (!(frequency > 0.0)) return {};
  a.row(1) /= frequency;
  a.col(1) *= frequency;
  const Eigen::EigenSolver<Eigen::Matrix<double, count, count>> eigen(a);
  const Eigen::Matrix<std::complex<double>, count, count> vectors = eigen.eigenvectors(), inverse = vectors.inverse();
  if (!(vectors.norm() * inverse.norm() < kMostCondition)) return {};
  Spectrum out;
  out.reserve(static_cast<std::size_t>(a.rows()));
  for (Eigen::Index k = 0; k < a.rows(); ++k) {
    const std::complex<double> value = eigen.eigenvalues()[k];
    if (value.imag() < 0.0) continue;
    out.push_back({value, (value.imag() > 0.0 ? 2.0 : 1.0) * vectors.col(k) * inverse.row(k)});
    out.back().projector.row(1) *= frequency;
    out.back().projector.col(1) /= frequency;
  }
  return out;
}

const ModalStep::Spectrum& ModalStep::spectrum(Eigen::Index mode) {
  std::shared_ptr<const Spectrum>& known = spectra_[static_cast<std::size_t>(mode)];
  if (!known) {
    const Eigen::MatrixXd a = system(mode);
    known = std::make_shared<const Spectrum>(states() == 2   ? spectrum_of<2>(a)
                                             : states() == 3 ? spectrum_of<3>(a)
                                                             : spectrum_of<Eigen::Dynamic>(a));
  }
  return *known;
}

Eigen::MatrixXd ModalStep::augmented_exponential(Eigen::Index mode, double step) const {
  const Eigen::Index n = states();
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n + 2, n + 2);
  a.topLeftCorner(n, n) = step * system(mode);
  a(1, n) = step;
  a(n, n + 1) = 1.0;
  return a.exp();
}

void ModalStep::prepare(double step) {
  if (std::abs(step - step_) < kSameStep) return;
  step_ = step;
  const Eigen::Index n = states();
  // `e` has columns for the states, for a constant force, and for one that grows from 0 to 1 over the step.
  const auto keep = [&](const auto& e, Eigen::Index mode) {
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) entry(i, j)[mode] = e(i, j);
      entry(i, n)[mode] = e(i, n) - e(i, n + 1);
      entry(i, n + 1)[mode] = e(i, n + 1);
    }
  };
  Eigen::MatrixXd sum(n, n + 2);
  for (Eigen::Index mode = 0; mode < square_.size(); ++mode) {
    if (branches_.empty() && oscillates(square_[mode], damping_[mode], step)) {
      keep(oscillation(square_[mode], damping_[mode], step), mode);
    } else if (const Spectrum& terms = spectrum(mode); terms.empty()) {
      keep(augmented_exponential(mode, step), mode);
    } else {
      sum.setZero();
      for (const Term& term : terms) {
        const std::complex<double> x = term.value * step, factor = std::exp(x);
        const auto [once, twice] = integrals(x, factor);
        sum.leftCols(n) += (factor * term.projector).real();
        sum.col(n) += step * (once * term.projector.col(1)).real();
        sum.col(n + 1) += step * (twice * term.projector.col(1)).real();
      }
      keep(sum, mode);
    }
  }
}

void ModalStep::advance(double step, const Eigen::VectorXd& before, const Eigen::VectorXd& after, Eigen::MatrixXd& state) {
  prepare(step);
  const Eigen::Index n = states();
  Eigen::ArrayXXd next(state.rows(), n);
  for (Eigen::Index i = 0; i < n; ++i) {
    next.col(i) = entry(i, n) * before.array() + entry(i, n + 1) * after.array();
    for (Eigen::Index j = 0; j < n; ++j) next.col(i) += entry(i, j) * state.col(j).array();
  }
  state = next;
}

Eigen::VectorXd ModalStep::stretch(const Eigen::MatrixXd& state, double stiffness_damping) const {
  Eigen::VectorXd out = state.col(0) + stiffness_damping * state.col(1);
  for (std::size_t i = 0; i < branches_.size(); ++i)
    out += branches_[i].modulus * (state.col(0) - state.col(2 + static_cast<Eigen::Index>(i)));
  return out;
}

}  // namespace tissue_stiffness
