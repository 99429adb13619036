#pragma once

#include <Eigen/Core>
#include <vector>

#include "forward/hyper_reduced_model.hpp"

namespace tissue_stiffness {

/// A hyper-reduced model at one theta. It is not thread safe.
class HyperReducedSystem {
 public:
  HyperReducedSystem(const HyperReducedModel& reduced, const Eigen::VectorXd& theta);

  const Eigen::MatrixXd& mass() const { return mass_; }
  /// Computes external minus internal and damping force at coordinates q and their rates.
  void force(double time, const Eigen::VectorXd& q, const Eigen::VectorXd& rate, Eigen::VectorXd& out);
  /// Computes -d force / d q without the damping's share, and -d force / d rate, at the time of the last force.
  void tangents(const Eigen::VectorXd& q, Eigen::MatrixXd& stiffness, Eigen::MatrixXd& damping);

 private:
  struct Law {
    const PointForm* form;
    Eigen::VectorXd parameters;
    double share, viscosity;  ///< of finite strain; factor of the moduli at rest [s]
  };
  struct Load {
    const LoadTerm* term;
    std::size_t part;
    double factor;
    Eigen::VectorXd pattern;
  };
  struct Follower {
    const QuadraticForce* force;
    const FollowerLoad* load;
    Eigen::VectorXd parameters;
    double share, now;  ///< of finite strain; size at the time of the last force
  };
  void add_part(std::size_t part, const Eigen::VectorXd& theta);
  void add_loads(std::size_t part);
  void deform(const Eigen::VectorXd& q);
  Lame viscosity(const Law& law, const SampledPoint& point) const;

  const HyperReducedModel& reduced_;
  Model::Point at_;
  Eigen::MatrixXd mass_, damping_, stiffness_;
  Eigen::VectorXd gravity_;
  std::vector<Law> laws_;
  std::vector<Load> loads_;
  std::vector<Follower> followers_;
  double beta_ = 0.0;
  bool viscous_ = false;                            ///< some law has viscous stress
  Eigen::VectorXd deformation_, rates_, stresses_;  ///< nine numbers for each point
  Eigen::MatrixXd weighted_, weighted_rates_;       ///< rows of the tangents' products
};

}  // namespace tissue_stiffness
