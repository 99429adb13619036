#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "effects/effect.hpp"
#include "fem/facet_quadrature.hpp"

namespace tissue_stiffness {

/// A rigid obstacle at one instant. Its signed distance changes by at most the length of a step.
class Obstacle {
 public:
  /// The signed distance of a point.
  struct Distance {
    double gap;                 ///< [m]; negative inside the obstacle
    Eigen::Vector3d normal;     ///< its gradient: a unit vector from the obstacle to the point
    Eigen::Matrix3d curvature;  ///< its second derivative [1/m]
  };
  virtual ~Obstacle() = default;
  virtual Distance distance(const Eigen::Vector3d& point) const = 0;
  /// Returns the velocity of the obstacle's material at a point [m/s].
  virtual Eigen::Vector3d velocity(const Eigen::Vector3d& /*point*/) const { return Eigen::Vector3d::Zero(); }
};

/// Contact of boundary facets with a rigid obstacle: a penalty at the quadrature points, with Coulomb's friction. The force
/// per rest area is
///   t = -k min(g, 0) (n - mu v / sqrt(v^2 + v0^2)),
/// where g is the signed distance of the deformed surface less the offset, n its gradient, and v the sliding velocity along
/// the obstacle. The body's size per 100 s is v0. Source: Wriggers, Computational Contact Mechanics, 2006, sec. 5.3.2
/// (penalty) and 5.2 (regularised friction). The tangents lack the change of friction with depth, which is not symmetric.
class RigidContact : public Effect, public NonlinearForce, public Contact {
 public:
  const NonlinearForce* nonlinear_force() const override { return this; }
  const Contact* contact() const override { return this; }

  bool has_velocity_tangent(const Parameters& p) const override { return friction(p) > 0.0; }
  void add_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override;
  void add_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override;
  void add_velocity_tangent(const Motion& motion, const Parameters& p, SparseMatrix& damping) const override;
  double energy(const Motion& motion, const Parameters& p) const override;

  const std::vector<int>& nodes() const override { return nodes_; }
  void find(const Motion& motion, const Parameters& p, std::vector<Touch>& out) const override;
  double travel(double from, double to, const Parameters& p) const override;

 protected:
  /// `fine`: the size of what the obstacle's surface has to be resolved to, for the quadrature [m].
  RigidContact(const EffectContext& context, std::vector<int> facets, double fine);

  /// Returns the obstacle; null where there is none yet.
  virtual std::shared_ptr<const Obstacle> obstacle(double time, const Parameters& p) const = 0;
  /// Returns how far it goes, as travel() does without friction.
  virtual double path(double from, double to) const = 0;
  virtual double offset(const Parameters& p) const = 0;    ///< of the obstacle's surface, outwards [m]
  virtual double penalty(const Parameters& p) const = 0;   ///< k [N/m^3]
  virtual double friction(const Parameters& p) const = 0;  ///< mu [-]
  /// Returns the mean length of the facets' edges [m].
  double mean_edge() const { return mean_edge_; }

 private:
  /// A quadrature point that is inside the obstacle.
  struct Inside {
    std::size_t facet;  ///< index into facets_
    int point;          ///< of the rule
    Obstacle::Distance distance;
    double stiffness;          ///< k times the point's area [N/m]
    Eigen::Vector3d position;  ///< [m]
  };
  template <typename Act>
  void for_each_inside(const Motion& motion, const Parameters& p, const Act& act) const;
  Touch touch(const Motion& motion, double friction, const Inside& inside, const Obstacle& obstacle) const;
  void rub(const Eigen::Vector3d& velocity, double friction, const Inside& inside, Touch& touch) const;
  template <typename Block>
  void add_to_pairs(const Motion& motion, const Parameters& p, const Block& block, SparseMatrix& matrix) const;

  const TetMesh& mesh_;
  const Discretisation& fem_;
  std::vector<int> facets_, nodes_;
  std::vector<std::vector<int>> local_;  ///< local numbers of the nodes of each of these facets
  double mean_edge_;
  FacetQuadrature rule_;
  double slow_;  ///< what slides more slowly sticks, nearly [m/s]
};

}  // namespace tissue_stiffness
