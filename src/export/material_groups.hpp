#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "export/exported_model.hpp"

namespace tissue_stiffness {

/// Tetrahedra with the same numbers.
struct MaterialGroup {
  double young_modulus, poisson_ratio, density;  ///< [Pa], [-], [kg/m^3]
  std::vector<int> tets;                         ///< ascending
};

/// Groups the tetrahedra, in the order in which their materials appear.
std::vector<MaterialGroup> material_groups(const ExportedModel& model);

/// Returns the nodes that are held at rest, ascending.
std::vector<int> fixed_nodes(const ExportedModel& model);
/// Returns those of them that are corners of tetrahedra.
std::vector<int> fixed_corners(const ExportedModel& model);

/// Returns the lines that stand at the top of a file: the title, units, the loads with their resultants, and the remarks.
std::vector<std::string> head_lines(const ExportedModel& model, const std::vector<std::string>& remarks);

}  // namespace tissue_stiffness
