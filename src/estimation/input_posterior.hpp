#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <vector>

#include "estimation/input_linearisation.hpp"

namespace tissue_stiffness {

constexpr double kTails = 2.0;  ///< variance of Student's distribution with 4 degrees of freedom and scale 1

/// This is the posterior of z = [w; eta], parameters and nuisance parameters. Their priors are normal and independent. The
/// likelihood of each recording i is taken to the power 1 / temperature (Miller & Dunson 2019).
///   -2 log p(z) = sum_i r_i(z)^T R_i^-1 r_i(z) / s_i + (z - m)^T P^-1 (z - m),
///   s_i = temperature_i max(1, mean square of the best r_i).
class InputPosterior {
 public:
  using Equations = std::vector<NormalEquations>;  ///< of each recording
  struct Fit {
    Eigen::VectorXd z;
    Equations normal;
  };
  /// These are the posterior's mean and covariance. `beyond_linear` is the covariance less that of the linear form at the
  /// mode.
  struct Moments {
    Fit mean;
    Eigen::MatrixXd beyond_linear;
  };

  using Rows = std::function<Equations(const Eigen::VectorXd& z, Constants constants)>;
  /// `prior_mean` and `prior_std` are those of the parameters. The nuisances have mean 0 and standard deviation
  /// `nuisance_std`.
  InputPosterior(Rows rows, const Eigen::VectorXd& prior_mean, const Eigen::VectorXd& prior_std,
                 const Eigen::VectorXd& nuisance_std);

  void set_temperature(std::size_t recording, double temperature);
  double temperature(std::size_t recording) const;
  Eigen::Index nuisance_count() const { return nuisance_std_.size(); }
  /// Returns the prior standard deviation of nuisance i of z.
  double nuisance_std(Eigen::Index i) const { return nuisance_std_[i - p_]; }
  void set_nuisance_std(Eigen::Index first, Eigen::Index count, double std);
  double widest_nuisance_std(Eigen::Index first, Eigen::Index count) const;

  /// Evaluates the rows at z = [w; 0].
  Fit at(const Eigen::VectorXd& w);
  /// Finds the mode by Gauss-Newton from [w; 0].
  Fit mode(const Eigen::VectorXd& w);
  /// Returns -2 log p at a fit, with `scales` for s.
  double cost(const Fit& fit, const Eigen::VectorXd& scales) const;
  /// Returns s of each recording.
  Eigen::VectorXd scales(const Equations& normal) const;
  /// Returns the sum of all recordings' equations, each over its s.
  NormalEquations sum(const Equations& normal, const Eigen::VectorXd& scales) const;
  /// Returns the inverse covariance of the linear form.
  Eigen::MatrixXd information(const Equations& normal) const;
  Eigen::MatrixXd covariance(const Equations& normal) const;
  /// These are the errors of constants that are most probable within their tolerances, in units of these, and by how much
  /// the mode of z moves with them.
  struct Tolerated {
    Eigen::VectorXd z, constants;
  };
  /// Returns them for the mode with these normal equations. No error leaves its 95 % interval, because the interval of the
  /// estimate allows for no more.
  Tolerated tolerated(const Equations& normal) const;
  /// Returns the share of nuisance i's prior variance that the data have taken away.
  double learnt(const Eigen::MatrixXd& covariance, Eigen::Index i) const;

  /// Integrates along the direction of the parameters in which the posterior is widest against the prior. At each point of
  /// the grid everything else takes its most probable value. The grid is refined until it resolves the curvature wherever
  /// the posterior has mass. A curvature at one maximum says nothing of the others (threshold effect; Van Trees 1968, sec.
  /// 4.2.3).
  Moments integrate(const Fit& mode);

 private:
  struct Line {
    Eigen::VectorXd direction;  ///< of w, one standard deviation of the linear form
    Eigen::VectorXd dual;       ///< its product with w is the place along the line, from the mode's on
    Eigen::VectorXd scales;
    double furthest;  ///< in standard deviations of the linear form
  };
  struct Point {
    double along, cost;
    double deviation;  ///< of the posterior along the line, by the curvature at this point
    Eigen::VectorXd z;
  };
  using Points = std::vector<Point>;

  bool improve(Fit& fit);
  Line line(const Fit& mode) const;
  Point most_probable(const Line& line, double along, Eigen::VectorXd z);
  void march(const Line& line, double side, Points& points);
  void refine(const Line& line, Points& points);
  Eigen::VectorXd prior_information() const;
  Eigen::VectorXd from_prior(const Eigen::VectorXd& z) const;

  Rows rows_;
  Eigen::Index p_, size_;
  Eigen::VectorXd prior_mean_, prior_std_, nuisance_std_;
  std::vector<double> temperatures_;  ///< of the first recordings; 1 of all others
};

}  // namespace tissue_stiffness
