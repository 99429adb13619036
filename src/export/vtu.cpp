// VTK's XML format, for ParaView, by VTK's own writer. GetPointer() is for VTK 7, whose vtkNew does not convert.
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkIntArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridWriter.h>

#include "export/formats.hpp"

namespace tissue_stiffness {
namespace {

// The node order of these cells is TetMesh's.
void add_grid(const TetMesh& mesh, vtkUnstructuredGrid& grid) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (int i = 0; i < mesh.node_count(); ++i) points->InsertNextPoint(mesh.nodes.col(i).data());
  grid.SetPoints(points.GetPointer());
  const auto size = static_cast<int>(mesh.tets.rows());
  std::vector<vtkIdType> nodes(static_cast<std::size_t>(size));
  for (int tet = 0; tet < mesh.tet_count(); ++tet) {
    for (int i = 0; i < size; ++i) nodes[static_cast<std::size_t>(i)] = mesh.tets(i, tet);
    grid.InsertNextCell(mesh.quadratic() ? VTK_QUADRATIC_TETRA : VTK_TETRA, size, nodes.data());
  }
}

/// Adds an array with a tuple for each column.
void add_numbers(const std::string& name, const Eigen::MatrixXd& columns, vtkFieldData& to) {
  vtkNew<vtkDoubleArray> array;
  array->SetName(name.c_str());
  array->SetNumberOfComponents(static_cast<int>(columns.rows()));
  for (Eigen::Index i = 0; i < columns.cols(); ++i) array->InsertNextTuple(columns.col(i).data());
  to.AddArray(array.GetPointer());
}

void add_flags(const std::string& name, const std::vector<char>& flags, vtkFieldData& to) {
  vtkNew<vtkIntArray> array;
  array->SetName(name.c_str());
  for (const char flag : flags) array->InsertNextValue(flag != 0 ? 1 : 0);
  to.AddArray(array.GetPointer());
}

void add_texts(const std::string& name, const std::vector<std::string>& texts, vtkFieldData& to) {
  vtkNew<vtkStringArray> array;
  array->SetName(name.c_str());
  for (const std::string& text : texts) array->InsertNextValue(text);
  to.AddArray(array.GetPointer());
}

void add_motions(const ExportedModel& model, vtkFieldData& to) {
  std::vector<char> moved(static_cast<std::size_t>(model.mesh.node_count()), 0);
  Eigen::Matrix3Xd displacement = Eigen::Matrix3Xd::Zero(3, model.mesh.node_count());
  for (const ExportedMotion& motion : model.motions) {
    for (std::size_t i = 0; i < motion.nodes.size(); ++i) {
      moved[static_cast<std::size_t>(motion.nodes[i])] = 1;
      displacement.col(motion.nodes[i]) = motion.displacement.col(static_cast<Eigen::Index>(i));
    }
  }
  add_flags("moved", moved, to);
  add_numbers("prescribed_displacement", displacement, to);
}

}  // namespace

ExportFile vtu_file(const ExportedModel& model) {
  vtkNew<vtkUnstructuredGrid> grid;
  add_grid(model.mesh, *grid.GetPointer());
  add_flags("fixed", model.fixed, *grid->GetPointData());
  add_numbers("load", model.force(), *grid->GetPointData());
  add_numbers("weight", model.weight, *grid->GetPointData());
  if (!model.motions.empty()) add_motions(model, *grid->GetPointData());
  add_numbers("young_modulus", model.young_modulus.transpose(), *grid->GetCellData());
  add_numbers("poisson_ratio", model.poisson_ratio.transpose(), *grid->GetCellData());
  add_numbers("density", model.density.transpose(), *grid->GetCellData());
  vtkFieldData& whole = *grid->GetFieldData();
  const auto number = [](double value) { return Eigen::MatrixXd::Constant(1, 1, value); };
  add_numbers("time", number(model.time), whole);
  add_numbers("gravity", model.gravity, whole);
  add_numbers("mass_damping", number(model.mass_damping), whole);
  add_numbers("stiffness_damping", number(model.stiffness_damping), whole);
  add_texts("law", {model.finite_strain ? "neo-Hookean" : "linear"}, whole);
  add_texts("title", {model.title}, whole);
  if (!model.remarks.empty()) add_texts("remarks", model.remarks, whole);
  vtkNew<vtkXMLUnstructuredGridWriter> writer;
  writer->SetInputData(grid.GetPointer());
  writer->SetDataModeToBinary();
  writer->WriteToOutputStringOn();
  writer->Write();
  return {writer->GetOutputString(), model.remarks};
}

}  // namespace tissue_stiffness
