#pragma once

#include <string>
#include <vector>

#include "export/exported_model.hpp"

namespace tissue_stiffness {

/// A model in another program's format.
struct ExportFile {
  std::string text;
  std::vector<std::string> remarks;  ///< the model's, and what this format cannot express; `text` holds them, too
};

/// Returns a `.vtu` for ParaView, written by VTK. Points have `fixed`, `load` [N], `weight` [N] and, where a motion is
/// prescribed, `moved` and `prescribed_displacement` [m]. Cells have `young_modulus` [Pa], `poisson_ratio` and `density`
/// [kg/m^3]. Field data has the numbers of the whole body and the remarks.
ExportFile vtu_file(const ExportedModel& model);

/// Returns an input file of CalculiX: a static step with the loads, and the displacement of every node in the `.dat` file.
ExportFile calculix_file(const ExportedModel& model);

/// Returns an input file of FEBio, version 4.0 of its format: a static analysis in which the loads rise from zero.
ExportFile febio_file(const ExportedModel& model);

/// Returns a scene of SOFA, 23.12 or later: the body settles under the constant loads. SOFA has no 10-node tetrahedra, so
/// the nodes on edges are dropped and their forces go to the corners.
ExportFile sofa_file(const ExportedModel& model);

/// Returns a layer of OpenUSD as text (`.usda`): a deformable body of the Omni Physics schemas on a `TetMesh`, attached
/// where it is fixed. What these schemas lack are attributes `tissueStiffness:...`: `load` [N] of every point, and
/// `youngsModulus` [Pa], `poissonsRatio` and `density` [kg/m^3] of every tetrahedron. Nodes on edges are dropped, as in
/// `sofa_file`.
ExportFile usd_file(const ExportedModel& model);

}  // namespace tissue_stiffness
