#include "meshing/numbered_tets.hpp"

namespace tissue_stiffness {

bool NumberedTets::add_node(long long number, const Eigen::Vector3d& point) {
  if (!place_.emplace(number, points_.size()).second) return false;
  points_.push_back(point);
  return true;
}

TetFile NumberedTets::assemble(const std::function<void(long long number)>& refuse) const {
  const std::size_t size = linear.empty() ? 10 : 4;
  std::vector<long long> list = linear.empty() ? quadratic : linear;
  for (std::size_t i = 0; size == 4 && i < quadratic.size(); i += 10) {
    const auto first = quadratic.begin() + static_cast<std::ptrdiff_t>(i);
    list.insert(list.end(), first, first + 4);
  }
  std::vector<int> order(points_.size(), -1);
  for (const long long number : list) {
    const auto found = place_.find(number);
    if (found == place_.end()) {
      refuse(number);
    } else {
      order[found->second] = 0;
    }
  }
  int used = 0;
  TetFile result{Eigen::Matrix3Xd(3, points_.size()), Eigen::MatrixXi(size, list.size() / size)};
  for (std::size_t i = 0; i < points_.size(); ++i) {
    if (order[i] < 0) continue;
    result.nodes.col(used) = points_[i];
    order[i] = used++;
  }
  result.nodes.conservativeResize(3, used);
  for (std::size_t i = 0; i < list.size(); ++i) {
    result.tets(static_cast<Eigen::Index>(i % size), static_cast<Eigen::Index>(i / size)) = order[place_.at(list[i])];
  }
  return result;
}

}  // namespace tissue_stiffness
