#include "fem/nodal_deformation.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <map>

namespace tissue_stiffness {
namespace {

constexpr int kGrain = 64;      // nodes that are worth a task
constexpr double kFlat = 0.05;  // determinant below which the gradient has no use

}  // namespace

NodalDeformation::NodalDeformation(const Discretisation& fem) : fem_(fem) {
  const auto nodes = static_cast<std::size_t>(fem.node_count());
  std::vector<std::map<int, Eigen::Vector3d>> sums(nodes);
  std::vector<double> volume(nodes, 0.0);
  for (int e = 0; e < fem.element_count(); ++e) {
    Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, fem.nodes_per_element());
    double weight = 0.0;
    for (int q = 0; q < fem.points_per_element(); ++q) {
      sum += fem.weight(e, q) * fem.gradient(e, q);
      weight += fem.weight(e, q);
    }
    for (int a = 0; a < fem.nodes_per_element(); ++a) {
      const auto node = static_cast<std::size_t>(fem.elements()(a, e));
      volume[node] += weight;
      for (int b = 0; b < fem.nodes_per_element(); ++b) {
        const auto known = sums[node].emplace(fem.elements()(b, e), Eigen::Vector3d::Zero()).first;
        known->second += sum.col(b);
      }
    }
  }
  first_.push_back(0);
  for (const auto& of_node : sums) first_.push_back(first_.back() + static_cast<int>(of_node.size()));
  gradients_.resize(3, first_.back());
  for (std::size_t node = 0; node < nodes; ++node) {
    for (const auto& [neighbour, sum] : sums[node]) {
      gradients_.col(static_cast<Eigen::Index>(neighbours_.size())) = sum / volume[node];
      neighbours_.push_back(neighbour);
    }
  }
}

void NodalDeformation::find(const Eigen::VectorXd& u, Eigen::Matrix3Xd& gradients) const {
  gradients.resize(3, fem_.dof_count());
  tbb::parallel_for(tbb::blocked_range<int>(0, fem_.node_count(), kGrain), [&](const tbb::blocked_range<int>& part) {
    for (int node = part.begin(); node < part.end(); ++node) {
      Eigen::Matrix3d f = Eigen::Matrix3d::Identity();
      const auto at = static_cast<std::size_t>(node);
      for (int k = first_[at]; k < first_[at + 1]; ++k) {
        f.noalias() += u.segment<3>(3 * neighbours_[static_cast<std::size_t>(k)]) * gradients_.col(k).transpose();
      }
      if (!(f.determinant() > kFlat)) f.setIdentity();
      gradients.middleCols<3>(3 * node) = f;
    }
  });
}

}  // namespace tissue_stiffness
