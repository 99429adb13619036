// GetPointer() is for VTK 7, whose vtkNew does not convert.
#include "vtu/vtu_reader.hpp"

#include <vtkCommand.h>
#include <vtkDataArraySelection.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkUnstructuredGrid.h>
#include <vtkVersionMacros.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <sstream>
#include <utility>

#include "meshing/mesh_limits.hpp"
#include "meshing/tets_apart.hpp"
#include "meshing/vtk_grid.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

#if VTK_MAJOR_VERSION * 100 + VTK_MINOR_VERSION >= 901
#include <vtkSMPTools.h>
#endif

namespace tissue_stiffness {
namespace {

constexpr unsigned kMaxSeconds = 120;

/// Keeps the first error of VTK, which comes with a line of VTK's source and an address.
class FirstError : public vtkCommand {
 public:
  static FirstError* New() { return new FirstError; }
  void Execute(vtkObject*, unsigned long, void* text) override {
    if (!sentence.empty() || text == nullptr) return;
    const std::string all = static_cast<const char*>(text);
    const std::size_t address = all.find("): ");
    std::istringstream rest(address == std::string::npos ? all : all.substr(address + 3));
    std::getline(rest, sentence);
    if (sentence.empty()) sentence = "an error of VTK's reader";
  }
  std::string sentence;
};

// The child has none of the threads that VTK would share its work among.
void work_alone() {
#if VTK_MAJOR_VERSION * 100 + VTK_MINOR_VERSION >= 901
  vtkSMPTools::SetBackend("Sequential");
#endif
}

VtkGrid grid_of(vtkUnstructuredGrid& from) {
  VtkGrid grid;
  grid.points.resize(3, from.GetNumberOfPoints());
  for (Eigen::Index i = 0; i < grid.points.cols(); ++i) from.GetPoint(i, grid.points.col(i).data());
  grid.offsets.push_back(0);
  vtkNew<vtkIdList> nodes;
  for (vtkIdType cell = 0; cell < from.GetNumberOfCells(); ++cell) {
    from.GetCellPoints(cell, nodes.GetPointer());
    for (vtkIdType i = 0; i < nodes->GetNumberOfIds(); ++i) grid.nodes.push_back(nodes->GetId(i));
    grid.offsets.push_back(static_cast<long long>(grid.nodes.size()));
    grid.types.push_back(from.GetCellType(cell));
  }
  return grid;
}

TetFile read_here(const std::string& file, const std::string& where) {
  work_alone();
  vtkNew<FirstError> error;
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->AddObserver(vtkCommand::ErrorEvent, error.GetPointer());
  reader->SetParserErrorObserver(error.GetPointer());
  reader->SetFileName(file.c_str());
  reader->UpdateInformation();
  reader->GetPointDataArraySelection()->DisableAllArrays();
  reader->GetCellDataArraySelection()->DisableAllArrays();
  if (error->sentence.empty()) reader->Update();
  const std::string allowed = "VTK's XML unstructured grid";
  if (!error->sentence.empty()) throw InputError(where, "what VTK refuses: " + error->sentence, allowed);
  return tets_of_grid(grid_of(*reader->GetOutput()),
                      [&](const std::string& found, const std::string& cells) { throw InputError(where, found, cells); });
}

}  // namespace

// VTK's reader trusts the sizes that a file states. Where that ends its process, this one goes on.
TetFile read_vtu(const std::string& file) {
  const std::string where = "mesh file " + file;
  if (read_file(file, where, "an existing mesh file", kLargestMeshFile).empty())
    throw InputError(where, "an empty file", "a mesh");
  auto mesh = make_tets_apart([&] { return read_here(file, where); }, kMaxSeconds);
  if (!mesh) throw InputError(where, "a file on which VTK's reader gives up", "VTK's XML unstructured grid");
  return *std::move(mesh);
}

void accept_vtu_meshes() {
  add_tet_reader(".vtu", read_vtu);
}

}  // namespace tissue_stiffness
