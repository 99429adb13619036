#pragma once

#include <Eigen/Core>
#include <complex>
#include <memory>
#include <vector>

#include "fem/relaxation.hpp"

namespace tissue_stiffness {

/// Exact step of q'' + d q' + w (q + sum gamma_i (q - z_i)) = f, tau_i z_i' = q - z_i, for each mode and f linear in time.
/// It uses the spectrum of each mode's system, which is the same for steps of all lengths. Where two eigenvalues nearly
/// coincide it uses the exponential of the system that is augmented by f and its increment (Van Loan 1978).
class ModalStep {
 public:
  /// `square`: w = omega^2 of each mode; `damping`: d = alpha + beta omega^2 [1/s]. Throws InputError for more than six
  /// branches.
  ModalStep(Eigen::VectorXd square, Eigen::VectorXd damping, std::vector<Relaxation> branches);

  int states() const { return 2 + static_cast<int>(branches_.size()); }
  /// Returns q + beta q' + sum gamma_i (q - z_i), with which the stiffness is multiplied; beta is `stiffness_damping` [s].
  Eigen::VectorXd stretch(const Eigen::MatrixXd& state, double stiffness_damping) const;
  /// Advances the state (columns q, q', z...; a row for each mode) while f changes from `before` to `after`.
  void advance(double step, const Eigen::VectorXd& before, const Eigen::VectorXd& after, Eigen::MatrixXd& state);

 private:
  /// One term of a mode's motion: what fades and turns with exp(value t). Of two conjugates only one is kept, doubled.
  struct Term {
    std::complex<double> value;  ///< eigenvalue [1/s]
    Eigen::MatrixXcd projector;  ///< states x states
  };
  using Spectrum = std::vector<Term>;  ///< of one mode; empty where eigenvalues nearly coincide

  void prepare(double step);
  Eigen::MatrixXd system(Eigen::Index mode) const;
  template <int count>
  static Spectrum spectrum_of(Eigen::Matrix<double, count, count> a);
  const Spectrum& spectrum(Eigen::Index mode);
  Eigen::MatrixXd augmented_exponential(Eigen::Index mode, double step) const;
  Eigen::ArrayXd& entry(Eigen::Index row, Eigen::Index column) {
    return transition_[static_cast<std::size_t>(row * (states() + 2) + column)];
  }

  Eigen::VectorXd square_, damping_;
  std::vector<Relaxation> branches_;
  double step_ = -1.0;
  std::vector<std::shared_ptr<const Spectrum>> spectra_;  ///< of each mode; null until it is needed
  std::vector<Eigen::ArrayXd> transition_;  ///< states x (states, f before, f after); each entry is an array over the modes
};

}  // namespace tissue_stiffness
