// The file for ParaView, read back by VTK.
#include <gtest/gtest.h>
#include <tbb/parallel_for.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkFieldData.h>
#include <vtkIdList.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkStringArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLUnstructuredGridReader.h>

#include <atomic>
#include <cstdio>
#include <fstream>

#include "example_model.hpp"
#include "export/formats.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"
#include "vtu/vtu_reader.hpp"

namespace tissue_stiffness {
namespace {

/// One column for each tuple of an array.
Eigen::MatrixXd numbers(vtkFieldData& data, const std::string& name) {
  vtkDataArray* array = data.GetArray(name.c_str());
  if (array == nullptr) {
    ADD_FAILURE() << "no " << name;
    return {};
  }
  Eigen::MatrixXd out(array->GetNumberOfComponents(), array->GetNumberOfTuples());
  for (Eigen::Index i = 0; i < out.cols(); ++i) array->GetTuple(i, out.col(i).data());
  return out;
}

std::vector<std::string> texts(vtkFieldData& data, const std::string& name) {
  auto* array = vtkStringArray::SafeDownCast(data.GetAbstractArray(name.c_str()));
  std::vector<std::string> out;
  for (vtkIdType i = 0; array != nullptr && i < array->GetNumberOfValues(); ++i) out.push_back(array->GetValue(i));
  return out;
}

/// The mesh of a model's file, as a program reads it that accepts the format.
TetMesh read_back(const ExportFile& exported, int order) {
  accept_vtu_meshes();
  const std::string file = testing::TempDir() + "read_back.vtu";
  std::ofstream(file) << exported.text;
  TetMesh mesh = load_tet_mesh(file, 1.0, order);
  std::remove(file.c_str());
  return mesh;
}

void expect_same(const TetMesh& found, const TetMesh& expected) {
  EXPECT_EQ(found.nodes, expected.nodes);
  EXPECT_EQ(found.tets, expected.tets);
  EXPECT_EQ(found.facets, expected.facets);
  EXPECT_EQ(found.corner_count, expected.corner_count);
}

class Vtu : public ::testing::TestWithParam<int> {
 protected:
  vtkUnstructuredGrid& read(const ExportFile& file) {
    reader_->ReadFromInputStringOn();
    reader_->SetInputString(file.text);
    reader_->Update();
    return *reader_->GetOutput();
  }
  TetMesh mesh() const { return make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, GetParam()); }

 private:
  vtkNew<vtkXMLUnstructuredGridReader> reader_;
};

TEST_P(Vtu, GivesBackTheModel) {
  const auto model = bar_model(bar_effects({"mass_damping: {alpha: 2.5}", "viscous_damping: {beta: 1.0e-3}",
                                            "viscoelasticity: {gamma: 0.5, tau: 0.1}"}),
                               mesh());
  ExportedModel bar = export_model(*model, model->parameters().known(), 12.0);
  bar.title = "a bar < 1 m & \"soft\"";
  const ExportFile file = vtu_file(bar);
  EXPECT_EQ(file.remarks, bar.remarks);
  vtkUnstructuredGrid& grid = read(file);
  ASSERT_EQ(grid.GetNumberOfPoints(), bar.mesh.node_count());
  ASSERT_EQ(grid.GetNumberOfCells(), bar.mesh.tet_count());
  for (int i = 0; i < bar.mesh.node_count(); ++i) {
    EXPECT_EQ(Eigen::Vector3d(grid.GetPoint(i)), bar.mesh.nodes.col(i));
    EXPECT_EQ(numbers(*grid.GetPointData(), "fixed")(0, i), bar.fixed[static_cast<std::size_t>(i)]);
  }
  for (int e = 0; e < bar.mesh.tet_count(); ++e) {
    EXPECT_EQ(grid.GetCellType(e), GetParam() == 1 ? 10 : 24);
    vtkNew<vtkIdList> nodes;
    grid.GetCellPoints(e, nodes.GetPointer());
    ASSERT_EQ(nodes->GetNumberOfIds(), bar.mesh.tets.rows());
    for (Eigen::Index i = 0; i < bar.mesh.tets.rows(); ++i) EXPECT_EQ(nodes->GetId(i), bar.mesh.tets(i, e));
  }
  EXPECT_EQ(numbers(*grid.GetPointData(), "load"), bar.force());
  EXPECT_EQ(numbers(*grid.GetPointData(), "weight"), bar.weight);
  EXPECT_EQ(numbers(*grid.GetCellData(), "young_modulus").transpose(), bar.young_modulus);
  EXPECT_EQ(numbers(*grid.GetCellData(), "poisson_ratio").transpose(), bar.poisson_ratio);
  EXPECT_EQ(numbers(*grid.GetCellData(), "density").transpose(), bar.density);
  vtkFieldData& whole = *grid.GetFieldData();
  EXPECT_EQ(numbers(whole, "time")(0, 0), 2.0);
  EXPECT_EQ(Eigen::Vector3d(numbers(whole, "gravity")), bar.gravity);
  EXPECT_EQ(numbers(whole, "mass_damping")(0, 0), 2.5);
  EXPECT_EQ(numbers(whole, "stiffness_damping")(0, 0), 1e-3);
  EXPECT_EQ(texts(whole, "law"), std::vector<std::string>{"linear"});
  EXPECT_EQ(texts(whole, "title"), std::vector<std::string>{bar.title});
  EXPECT_EQ(texts(whole, "remarks"), bar.remarks);
  EXPECT_EQ(bar.remarks.size(), 1U);
}

TEST_P(Vtu, IsReadBackAsTheSameMesh) {
  const auto model = bar_model(bar_effects(), mesh());
  const ExportedModel bar = export_model(*model, model->parameters().known(), 12.0);
  expect_same(read_back(vtu_file(bar), GetParam()), bar.mesh);
}

INSTANTIATE_TEST_SUITE_P(Orders, Vtu, ::testing::Values(1, 2));

// VTK shares large work among threads, which the process that reads the file does not have.
TEST(VtuMesh, IsReadBackWhereThreadsHaveRun) {
  std::atomic<int> sum{0};
  tbb::parallel_for(0, 1000, [&](int i) { sum += i; });
  EXPECT_EQ(sum, 499500);
  ExportedModel bar = export_bar(bar_effects());
  bar.mesh = make_box_mesh({0.1, 0.1, 0.1}, 20, 20, 20, 1);
  const auto tets = static_cast<Eigen::Index>(bar.mesh.tet_count());
  bar.fixed.assign(static_cast<std::size_t>(bar.mesh.node_count()), 0);
  bar.loads.clear();
  bar.weight.setZero(3, bar.mesh.node_count());
  bar.young_modulus = bar.poisson_ratio = bar.density = Eigen::VectorXd::Constant(tets, 0.25);
  expect_same(read_back(vtu_file(bar), 1), bar.mesh);
}

TEST(VtuMotion, IsOnTheNodesThatAreMoved) {
  ExportedModel bar = export_bar(bar_effects());
  bar.motions.push_back({"moved on tip", {3, 5}, Eigen::Matrix3Xd::Constant(3, 2, 0.25)});
  vtkNew<vtkXMLUnstructuredGridReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(vtu_file(bar).text);
  reader->Update();
  vtkPointData& points = *reader->GetOutput()->GetPointData();
  const Eigen::MatrixXd moved = numbers(points, "moved"), displacement = numbers(points, "prescribed_displacement");
  EXPECT_EQ(moved.sum(), 2.0);
  EXPECT_EQ(moved(0, 5), 1.0);
  EXPECT_EQ(displacement(2, 3), 0.25);
  EXPECT_EQ(displacement.sum(), 1.5);
}

}  // namespace
}  // namespace tissue_stiffness
