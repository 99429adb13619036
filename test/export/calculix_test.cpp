// CalculiX's input file. CalculiX itself runs it and finds the displacement that the package finds.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "example_model.hpp"
#include "export/formats.hpp"
#include "forward/static_response.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

bool has_calculix() {
  return std::system("command -v ccx > /dev/null 2>&1") == 0;
}

/// The displacement in CalculiX's .dat file, 3 x nodes [m].
Eigen::Matrix3Xd read_displacement(const std::string& file, int nodes) {
  Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Constant(3, nodes, std::numeric_limits<double>::quiet_NaN());
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream row(line);
    int node = 0;
    double x = 0.0, y = 0.0, z = 0.0;
    if (row >> node >> x >> y >> z && node >= 1 && node <= nodes) out.col(node - 1) << x, y, z;  // the last increment's
  }
  return out;
}

Eigen::Matrix3Xd solve_by_calculix(const ExportedModel& model) {
  std::string folder = (std::filesystem::temp_directory_path() / "tissue_stiffness_XXXXXX").string();
  if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error("no folder for CalculiX");
  std::ofstream(folder + "/bar.inp") << calculix_file(model).text;
  const std::string command = "cd " + folder + " && OMP_NUM_THREADS=1 ccx -i bar > log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  std::ifstream log(folder + "/log");
  const std::string said{std::istreambuf_iterator<char>(log), {}};
  EXPECT_EQ(said.find("*WARNING"), std::string::npos) << said;
  EXPECT_EQ(said.find("*ERROR"), std::string::npos) << said;
  EXPECT_NE(said.find("Job finished"), std::string::npos) << said;
  const Eigen::Matrix3Xd out = read_displacement(folder + "/bar.dat", model.mesh.node_count());
  std::filesystem::remove_all(folder);
  return out;
}

/// The package's own static solution under the model's loads, 3 x nodes [m].
Eigen::Matrix3Xd solve(const Model& model, double time) {
  const Eigen::VectorXd theta = model.parameters().known();
  const SparseMatrix mass = model.mass(theta);
  Eigen::VectorXd force = mass * model.body_acceleration(theta).replicate(model.fem().node_count(), 1);
  model.add_loads(model.point(theta), time, force);
  const Eigen::MatrixXd u = StaticResponse(model.rest_stiffness(theta), mass, model.fixed(theta), nullptr)(force);
  return Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.rows() / 3);
}

void expect_same(const Model& model, double time, double tolerance) {
  const Eigen::Matrix3Xd expected = solve(model, time);
  const Eigen::Matrix3Xd found = solve_by_calculix(export_model(model, model.parameters().known(), time));
  ASSERT_GT(expected.norm(), 0.0);
  EXPECT_LT((found - expected).norm(), tolerance * expected.norm());
}

class Calculix : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!has_calculix()) GTEST_SKIP() << "ccx is not installed (scripts/install_dependencies --calculix)";
  }
};

TEST_F(Calculix, FindsTheSameDisplacement) {
  for (const int order : {1, 2}) {
    const auto model =
        bar_model(bar_effects({"force_scale: {relative: 0.25}", "pressure_offset: {region: top, pressure: 3}"}),
                  make_box_mesh({0.10, 0.02, 0.02}, 5, 2, 2, order));
    expect_same(*model, 12.5, 1e-4);
  }
}

TEST_F(Calculix, FindsItWithDampingAndAnotherCompressibility) {
  expect_same(*bar_model(bar_effects(
                  {"compressibility: {shift: 0.04}", "mass_damping: {alpha: 2.5}", "viscous_damping: {beta: 1.0e-3}"})),
              12.0, 1e-4);
}

// In the model, the inclusion's edge cuts through tetrahedra.
TEST_F(Calculix, FindsItNearlyWithAnInclusion) {
  const auto plain = bar_model(bar_effects(), bar_mesh(8, 2, 2));
  const auto stiff = bar_model(bar_effects({"stiff_inclusion: {excess: 3.0, center: [0.03, 0.01, 0.01], radius: 0.02}"}),
                               bar_mesh(8, 2, 2));
  EXPECT_LT(solve(*stiff, 12.0).norm(), 0.7 * solve(*plain, 12.0).norm()) << "the tolerance would hide the inclusion";
  expect_same(*stiff, 12.0, 0.1);
}

TEST_F(Calculix, FindsItWhereARegionIsMoved) {
  const auto model = bar_model({"inertia: {density: 1000}", "fixed: {region: clamp}",
                                "elasticity: {law: linear, young_modulus: 1000, poisson_ratio: 0.3}",
                                "moved: {region: tip, topic: /arm, smoothing: 0}"});
  Eigen::Isometry3d turned = Eigen::Isometry3d::Identity();
  turned.translation() << 0.001, 0.0, 0.002;
  turned.linear() = Eigen::AngleAxisd(0.05, Eigen::Vector3d::UnitX()).toRotationMatrix();
  model->loads().drive(10.0,
                       {{"/arm", 10.0, pose_values(Eigen::Isometry3d::Identity())}, {"/arm", 11.0, pose_values(turned)}});
  expect_same(*model, 11.0, 1e-2);
}

// A small load, under which the laws agree.
TEST_F(Calculix, HasTheLawOfFiniteStrain) {
  const auto model = bar_model({"inertia: {density: 1000}", "fixed: {region: clamp}",
                                "elasticity: {law: neo_hookean, young_modulus: 1.0e6, poisson_ratio: 0.4}",
                                "load_offset: {region: tip, force: [0, 0, 0.001]}"});
  ASSERT_TRUE(export_model(*model, model->parameters().known(), 0.0).finite_strain);
  const Eigen::VectorXd theta = model->parameters().known();
  Eigen::VectorXd force = Eigen::VectorXd::Zero(model->fem().dof_count());
  const Eigen::Matrix3Xd load = export_model(*model, theta, 0.0).force();
  force = Eigen::Map<const Eigen::VectorXd>(load.data(), load.size());
  const Eigen::MatrixXd u =
      StaticResponse(model->rest_stiffness(theta), model->mass(theta), model->fixed(theta), nullptr)(force);
  const Eigen::Matrix3Xd found = solve_by_calculix(export_model(*model, theta, 0.0));
  EXPECT_LT((found - Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.rows() / 3)).norm(), 1e-2 * u.norm());
}

TEST(CalculixFile, IsReadBackAsTheSameMesh) {
  for (const int order : {1, 2}) {
    const auto model = bar_model(bar_effects(), make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, order));
    const ExportedModel bar = export_model(*model, model->parameters().known(), 12.0);
    const std::string file = testing::TempDir() + "read_back.inp";
    std::ofstream(file) << calculix_file(bar).text;
    const TetMesh mesh = load_tet_mesh(file, 1.0, order);
    std::filesystem::remove(file);
    EXPECT_EQ(mesh.corner_count, bar.mesh.corner_count);
    EXPECT_EQ(mesh.tets, bar.mesh.tets);
    EXPECT_EQ(mesh.facets, bar.mesh.facets);
    ASSERT_EQ(mesh.nodes.cols(), bar.mesh.nodes.cols());
    EXPECT_LT((mesh.nodes - bar.mesh.nodes).cwiseAbs().maxCoeff(), 1e-13);  // the file has 12 digits
  }
}

TEST(CalculixFile, SaysWhatItLeavesOut) {
  const ExportFile file = calculix_file(
      export_bar(bar_effects({"viscoelasticity: {gamma: 0.5, tau: 0.1}", "viscous_damping: {beta: 1.0e-3}"})));
  ASSERT_EQ(file.remarks.size(), 2U);
  EXPECT_NE(file.text.find("** Note: viscoelasticity is left out"), std::string::npos);
  EXPECT_NE(file.text.find("** Note: the damping has no effect"), std::string::npos);
  EXPECT_NE(file.text.find("*DAMPING, ALPHA=0, BETA=0.001\n"), std::string::npos);
  EXPECT_NE(file.text.find("** traction on tip: in sum 0.02, 0.01, -0.04 N"), std::string::npos)
      << file.text.substr(0, 800);
  EXPECT_LT(file.text.find("*MATERIAL, NAME=TISSUE2"), std::string::npos);
  EXPECT_EQ(file.text.find("*MATERIAL, NAME=TISSUE3"), std::string::npos) << "there are two materials";
  std::istringstream lines(file.text);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 132U) << line;
}

}  // namespace
}  // namespace tissue_stiffness
