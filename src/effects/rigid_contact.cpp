#include "effects/rigid_contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSlow = 0.01;   // body sizes a second
constexpr double kReach = 1.25;  // of the nodes' distance from their middle: a curved facet bulges
constexpr int kMostDivisions = 8;

// A facet may be larger than where it is touched.
int divisions(double edge, double fine) {
  return static_cast<int>(std::min<double>(kMostDivisions, std::max(1.0, std::ceil(edge / fine))));
}

double find_mean_edge(const TetMesh& mesh, const std::vector<int>& facets) {
  double sum = 0.0;
  for (const int f : facets) sum += (mesh.nodes.col(mesh.facets(0, f)) - mesh.nodes.col(mesh.facets(1, f))).norm();
  return sum / static_cast<double>(facets.size());
}

}  // namespace

RigidContact::RigidContact(const EffectContext& context, std::vector<int> facets, double fine)
    : mesh_(context.mesh),
      fem_(context.fem),
      facets_(std::move(facets)),
      mean_edge_(find_mean_edge(mesh_, facets_)),
      rule_(static_cast<int>(context.mesh.facets.rows()), divisions(mean_edge_, fine)),
      slow_(kSlow * body_size(context.mesh.nodes)) {
  std::set<int> nodes;
  for (const int f : facets_) {
    local_.push_back(facet_local_nodes(mesh_, f));
    for (Eigen::Index a = 0; a < mesh_.facets.rows(); ++a) nodes.insert(mesh_.facets(a, f));
  }
  nodes_.assign(nodes.begin(), nodes.end());
}

template <typename Act>
void RigidContact::for_each_inside(const Motion& motion, const Parameters& p, const Act& act) const {
  const std::shared_ptr<const Obstacle> there = obstacle(motion.time, p);
  if (!there) return;
  const double k = penalty(p), out = offset(p);
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const FacetNodes x = facet_nodes(mesh_, facets_[i], &motion.displacement);
    const Eigen::Vector3d middle = x.rowwise().mean();
    const double gap = there->distance(middle).gap - out;
    if (gap > kReach * (x.colwise() - middle).colwise().norm().maxCoeff()) continue;
    const FacetNodes at_rest = facet_nodes(mesh_, facets_[i]);
    for (int q = 0; q < rule_.points(); ++q) {
      Inside inside{i, q, {}, 0.0, x * rule_.shape(q)};
      if ((inside.position - middle).norm() < gap) continue;  // no step leads nearer than its length
      inside.distance = there->distance(inside.position);
      inside.distance.gap -= out;
      if (inside.distance.gap >= 0.0) continue;
      inside.stiffness = k * rule_.weight(q) * rule_.normal(at_rest, q).norm();
      act(inside, *there);
    }
  }
}

Contact::Touch RigidContact::touch(const Motion& motion, double friction, const Inside& inside,
                                   const Obstacle& obstacle) const {
  const Obstacle::Distance& d = inside.distance;
  Touch out;
  out.nodes = mesh_.facets.col(facets_[inside.facet]);
  out.shape = rule_.shape(inside.point);
  out.force = -inside.stiffness * d.gap * d.normal;
  out.stiffness = inside.stiffness * (d.normal * d.normal.transpose() + d.gap * d.curvature);
  out.damping.setZero();
  if (!(friction > 0.0)) return out;
  Eigen::Vector3d velocity = -obstacle.velocity(inside.position);
  for (Eigen::Index a = 0; a < out.nodes.size(); ++a)
    velocity += out.shape[a] * motion.velocity.segment<3>(3 * out.nodes[a]);
  rub(velocity, friction, inside, out);
  return out;
}

void RigidContact::rub(const Eigen::Vector3d& velocity, double friction, const Inside& inside, Touch& touch) const {
  const Eigen::Vector3d& n = inside.distance.normal;
  const Eigen::Matrix3d along = Eigen::Matrix3d::Identity() - n * n.transpose();
  const Eigen::Vector3d sliding = along * velocity;
  const double speed = std::sqrt(sliding.squaredNorm() + slow_ * slow_);
  const double factor = -friction * inside.stiffness * inside.distance.gap / speed;
  touch.force -= factor * sliding;
  touch.damping = factor * (along - sliding * sliding.transpose() / (speed * speed));
}

void RigidContact::find(const Motion& motion, const Parameters& p, std::vector<Touch>& out) const {
  const double mu = friction(p);
  for_each_inside(motion, p,
                  [&](const Inside& inside, const Obstacle& there) { out.push_back(touch(motion, mu, inside, there)); });
}

double RigidContact::travel(double from, double to, const Parameters& p) const {
  return friction(p) > 0.0 ? std::numeric_limits<double>::infinity() : path(from, to);
}

void RigidContact::add_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const {
  const double mu = friction(p);
  for_each_inside(motion, p, [&](const Inside& inside, const Obstacle& there) {
    const Touch t = touch(motion, mu, inside, there);
    for (Eigen::Index a = 0; a < t.nodes.size(); ++a) force.segment<3>(3 * t.nodes[a]) += t.shape[a] * t.force;
  });
}

// Adds N_a N_b block for each pair of a facet's nodes.
template <typename Block>
void RigidContact::add_to_pairs(const Motion& motion, const Parameters& p, const Block& block, SparseMatrix& matrix) const {
  const double mu = friction(p);
  for_each_inside(motion, p, [&](const Inside& inside, const Obstacle& there) {
    const Touch t = touch(motion, mu, inside, there);
    const std::vector<int>& local = local_[inside.facet];
    const int tet = mesh_.facet_tet[facets_[inside.facet]];
    for (std::size_t b = 0; b < local.size(); ++b) {
      for (std::size_t a = 0; a < local.size(); ++a) {
        const double n = t.shape[static_cast<Eigen::Index>(a)] * t.shape[static_cast<Eigen::Index>(b)];
        fem_.add_block(matrix, tet, local[a], local[b], n * block(t));
      }
    }
  });
}

void RigidContact::add_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const {
  add_to_pairs(
      motion, p, [](const Touch& t) -> const Eigen::Matrix3d& { return t.stiffness; }, stiffness);
}

void RigidContact::add_velocity_tangent(const Motion& motion, const Parameters& p, SparseMatrix& damping) const {
  add_to_pairs(
      motion, p, [](const Touch& t) -> const Eigen::Matrix3d& { return t.damping; }, damping);
}

double RigidContact::energy(const Motion& motion, const Parameters& p) const {
  double sum = 0.0;
  for_each_inside(motion, p, [&](const Inside& inside, const Obstacle&) {
    sum += 0.5 * inside.stiffness * inside.distance.gap * inside.distance.gap;
  });
  return sum;
}

}  // namespace tissue_stiffness
