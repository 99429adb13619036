#include "export/material_groups.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <sstream>

namespace tissue_stiffness {

std::vector<MaterialGroup> material_groups(const ExportedModel& model) {
  std::vector<MaterialGroup> groups;
  std::map<std::array<double, 3>, std::size_t> known;
  for (int e = 0; e < model.mesh.tet_count(); ++e) {
    const std::array<double, 3> numbers = {model.young_modulus[e], model.poisson_ratio[e], model.density[e]};
    const auto [at, is_new] = known.emplace(numbers, groups.size());
    if (is_new) groups.push_back({numbers[0], numbers[1], numbers[2], {}});
    groups[at->second].tets.push_back(e);
  }
  return groups;
}

std::vector<int> fixed_nodes(const ExportedModel& model) {
  std::vector<int> nodes;
  for (std::size_t i = 0; i < model.fixed.size(); ++i) {
    if (model.fixed[i] != 0) nodes.push_back(static_cast<int>(i));
  }
  return nodes;
}

std::vector<int> fixed_corners(const ExportedModel& model) {
  std::vector<int> nodes = fixed_nodes(model);
  nodes.erase(std::lower_bound(nodes.begin(), nodes.end(), model.mesh.corner_count), nodes.end());
  return nodes;
}

std::vector<std::string> head_lines(const ExportedModel& model, const std::vector<std::string>& remarks) {
  std::vector<std::string> lines;
  if (!model.title.empty()) lines.push_back(model.title);
  std::ostringstream units;
  units << "Units are m, kg, s, N and Pa. The loads are those at " << model.time << " s.";
  lines.push_back(units.str());
  for (const ExportedLoad& load : model.loads) {
    const Eigen::Vector3d sum = load.force.rowwise().sum();
    std::ostringstream text;
    text << load.name << ": in sum " << sum.x() << ", " << sum.y() << ", " << sum.z() << " N, as forces on its nodes.";
    lines.push_back(text.str());
  }
  for (const std::string& remark : remarks) lines.push_back("Note: " + remark);
  return lines;
}

}  // namespace tissue_stiffness
