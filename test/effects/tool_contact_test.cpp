// A tool touches the body: where, how hard, and what a sensor at the tool measures.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <sstream>

#include "../block_model.hpp"
#include "../box_model.hpp"
#include "../written_file.hpp"
#include "fem/facet_quadrature.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kModulus = 2e4, kPenalty = 1e6;

Eigen::VectorXd prior(const Model& model) {
  return model.parameters().theta(model.parameters().prior_mean());
}

ModelSettings settings(const std::string& tool, double ratio = 0.0) {
  return block_settings({"elasticity: {law: linear, young_modulus: 2.0e4, poisson_ratio: " + std::to_string(ratio) + "}",
                         "mass_damping: {alpha: 400}", touching(tool)});
}

void place(Model& model, double time, const Eigen::Isometry3d& pose) {
  model.loads().set_first_stamp(0.0);
  model.loads().courses().at("/pose")->add(time, pose_values(pose));
}

Eigen::Isometry3d at(double x, double y, double z) {
  return Eigen::Isometry3d(Eigen::Translation3d(x, y, z));
}

// Resultant of the contact's force on a body that is not deformed.
Eigen::Vector3d push(const Model& model, double time = 0.0, const Eigen::Vector3d& velocity = Eigen::Vector3d::Zero()) {
  const Eigen::Index n = model.fem().dof_count();
  const Eigen::VectorXd u = Eigen::VectorXd::Zero(n), v = velocity.replicate(n / 3, 1);
  Eigen::VectorXd force = Eigen::VectorXd::Zero(n);
  const Model::Part& part = model.parts().back();
  part.effect->nonlinear_force()->add_force({time, u, v}, part.parameters(prior(model)), force);
  return resultant(force);
}

TEST(ToolContact, ABallPushesAlongItsNormalAndOnlyWhereItIs) {
  Model model(settings("center: [0, 0, 0], radius: 0.1, stiffness: 1e6"), block_mesh());
  EXPECT_EQ(push(model).norm(), 0.0);  // nobody knows yet where the tool is
  place(model, 0.0, at(0.01, 0.01, 0.1205));
  EXPECT_EQ(push(model).norm(), 0.0);  // half a millimetre above
  place(model, 0.0, at(0.01, 0.01, 0.1195));
  const Eigen::Vector3d force = push(model);
  // The ball's cap has the volume pi d^2 (R - d / 3), and each of its points pushes by k times its depth.
  const double cap = M_PI * 0.0005 * 0.0005 * (0.1 - 0.0005 / 3.0);
  EXPECT_NEAR(force.z(), -kPenalty * cap, 0.05 * kPenalty * cap);
  EXPECT_LT(force.head<2>().norm(), 0.02 * force.norm());
}

TEST(ToolContact, TheOffsetGrowsTheToolAndTheTurnMovesIt) {
  Model model(settings("center: [0, 0.1, 0], radius: 0.1, stiffness: 1e6, offset: 0.0005"), block_mesh());
  // The tool's y axis shows downwards: its ball is 0.1 m below the pose's place.
  const Eigen::Isometry3d turned =
      Eigen::Translation3d(0.01, 0.01, 0.22) * Eigen::AngleAxisd(-0.5 * M_PI, Eigen::Vector3d::UnitX());
  place(model, 0.0, turned);
  const double cap = M_PI * 0.0005 * 0.0005 * (0.1 - 0.0005 / 3.0);
  EXPECT_NEAR(push(model).z(), -kPenalty * cap, 0.05 * kPenalty * cap);
}

TEST(ToolContact, ACapsuleAcrossTheBlockPushesAsALine) {
  Model model(settings("center: [-0.05, 0, 0], end: [0.05, 0, 0], radius: 0.05, stiffness: 1e6"), block_mesh(4));
  place(model, 0.0, at(0.01, 0.01, 0.0695));
  const double half = std::acos(1.0 - 0.0005 / 0.05), segment = 0.05 * 0.05 * (half - std::sin(half) * std::cos(half));
  EXPECT_NEAR(push(model).z(), -kPenalty * segment * 0.02, 0.05 * kPenalty * segment * 0.02);
}

TEST(ToolContact, AFlatPunchPushesEvenly) {
  Model model(settings("center: [0, 0, 0], end: [0, 0, 0.05], flat: true, radius: 0.1, stiffness: 1e6"), block_mesh());
  place(model, 0.0, at(0.01, 0.01, 0.0195));
  EXPECT_NEAR(push(model).z(), -kPenalty * 0.0005 * 4e-4, 1e-9);
}

std::string surface(const WrittenFile& tool, const std::string& further = "") {
  return "surface: {file: " + tool.name + further + "}";
}

// A box of 200 x 200 x 50 mm whose lower side is at z = 0, in millimetres.
std::string box_in_millimetres(int sides = 6) {
  std::string text;
  for (const int z : {0, 50}) {
    for (const char* corner : {"-100 -100", "100 -100", "100 100", "-100 100"})
      text += std::string("v ") + corner + " " + std::to_string(z) + "\n";
  }
  const char* quads[] = {"4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"};
  for (int side = 0; side < sides; ++side) text += std::string("f ") + quads[side] + "\n";
  return text;
}

// A ball of 0.1 m about the origin, of rings of quadrangles.
std::string ball_of_facets(int rings) {
  std::ostringstream text;
  const int around = 2 * rings;
  for (int ring = 1; ring < rings; ++ring) {
    for (int k = 0; k < around; ++k) {
      const double polar = M_PI * ring / rings, turn = 2.0 * M_PI * k / around;
      text << "v " << 0.1 * std::sin(polar) * std::cos(turn) << " " << 0.1 * std::sin(polar) * std::sin(turn) << " "
           << 0.1 * std::cos(polar) << "\n";
    }
  }
  const int poles = (rings - 1) * around;
  text << "v 0 0 0.1\nv 0 0 -0.1\n";
  for (int k = 0; k < around; ++k) {
    const int next = (k + 1) % around;
    text << "f " << poles + 1 << " " << k + 1 << " " << next + 1 << "\n";
    text << "f " << poles + 2 << " " << poles - around + next + 1 << " " << poles - around + k + 1 << "\n";
    for (int ring = 0; ring + 2 < rings; ++ring) {
      const int upper = ring * around + 1, lower = upper + around;
      text << "f " << upper + k << " " << lower + k << " " << lower + next << " " << upper + next << "\n";
    }
  }
  return text.str();
}

TEST(ToolContact, ASurfaceFilePushesAsTheBodyThatItHolds) {
  const WrittenFile box("box.obj", box_in_millimetres());
  Model punch(settings(surface(box, ", scale: 0.001") + ", stiffness: 1e6"), block_mesh());
  place(punch, 0.0, at(0.01, 0.01, 0.0195));
  EXPECT_NEAR(push(punch).z(), -kPenalty * 0.0005 * 4e-4, 1e-9);
  place(punch, 0.0, at(0.01, 0.01, 0.0205));
  EXPECT_EQ(push(punch).norm(), 0.0);
  // It lies on its side: what was its face at x = 100 mm is below.
  place(punch, 0.0, at(-0.02, 0.01, 0.1195) * Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitY()));
  EXPECT_NEAR(push(punch).z(), -kPenalty * 0.0005 * 4e-4, 1e-9);
  Model grown(settings(surface(box, ", scale: 0.001") + ", stiffness: 1e6, offset: 0.001"), block_mesh());
  place(grown, 0.0, at(0.01, 0.01, 0.0205));
  EXPECT_NEAR(push(grown).z(), -kPenalty * 0.0005 * 4e-4, 1e-9);
}

TEST(ToolContact, ABallOfManyFacetsPushesAsABall) {
  const WrittenFile ball("ball.obj", ball_of_facets(120));
  Model facets(settings(surface(ball) + ", stiffness: 1e6, friction: 0.2"), block_mesh());
  Model smooth(settings("center: [0, 0, 0], radius: 0.1, stiffness: 1e6, friction: 0.2"), block_mesh());
  for (Model* model : {&facets, &smooth}) {
    for (int k = 0; k <= 4; ++k) place(*model, 0.01 * k, at(0.01 + 0.001 * k, 0.008, 0.1185));
  }
  const Eigen::Vector3d expected = push(smooth, 0.02);
  EXPECT_GT(expected.x(), 0.1 * -expected.z());  // it drags the block along
  EXPECT_LT((push(facets, 0.02) - expected).norm(), 0.03 * expected.norm());
}

TEST(ToolContact, ATouchedBodyIsDraggedAlong) {
  Model model(settings("center: [0, 0, 0], end: [0, 0, 0.05], flat: true, radius: 0.1, stiffness: 1e6, friction: 0.3"),
              block_mesh());
  for (int k = 0; k <= 10; ++k) place(model, 0.01 * k, at(0.01 + 0.001 * k, 0.01, 0.0195));  // 0.1 m/s
  const Eigen::Vector3d dragged = push(model, 0.05), still = push(model, 0.05, {0.1, 0.0, 0.0});
  EXPECT_NEAR(dragged.x(), 0.3 * -dragged.z(), 1e-5 * -dragged.z());
  EXPECT_NEAR(still.x(), 0.0, 1e-9 * -still.z());  // both move alike
}

// A column that is compressed by a wide punch has the force E A d / L, less what the penalty gives way.
TEST(ToolContact, ItsSensorMeasuresTheForceOfAColumn) {
  Model model(settings("center: [0, 0, 0], end: [0, 0, 0.05], flat: true, radius: 0.1, stiffness: 1e9"), block_mesh());
  for (int k = 0; k <= 100; ++k) place(model, 0.01 * k, at(0.01, 0.01, 0.02 - 0.0004 * std::min(1.0, 0.02 * k)));
  ASSERT_EQ(model.output_size(), model.fem().dof_count() + 3);
  FullModel::Options options;
  options.step = 0.005;
  const auto run = FullModel(model, options).start(prior(model), 0.0);
  run->advance(1.0);
  const double expected = -kModulus * 4e-4 * 0.0004 / 0.02;
  std::printf("column: %.5f N, by hand %.5f N\n", run->output().tail<3>().z(), expected);
  EXPECT_NEAR(run->output().tail<3>().z(), expected, 2e-3 * -expected);
  EXPECT_LT(run->output().tail<3>().head<2>().norm(), 1e-6 * -expected);
}

// Where the tool's motion is given, the deformed shape does not depend on the modulus: the default penalty goes with it.
TEST(ToolContact, TheForceGoesWithTheModulus) {
  Model model(settings("center: [0, 0, 0], radius: 0.02", 0.4), block_mesh());
  for (int k = 0; k <= 100; ++k) place(model, 0.01 * k, at(0.01, 0.01, 0.04 - 0.001 * std::min(1.0, 0.02 * k)));
  FullModel::Options options;
  options.step = 0.01;
  Eigen::VectorXd theta = prior(model);
  const auto soft = FullModel(model, options).start(theta, 0.0);
  for (const int index : model.parts()[2].indices) {
    if (theta[index] == kModulus) theta[index] *= 2.0;
  }
  const auto stiff = FullModel(model, options).start(theta, 0.0);
  soft->advance(1.0);
  stiff->advance(1.0);
  const double ratio = stiff->output().tail<3>().z() / soft->output().tail<3>().z();
  EXPECT_NEAR(ratio, 2.0, 2e-3);
}

TEST(ToolContact, ARefusalNamesWhatIsAllowed) {
  const TetMesh mesh = block_mesh();
  const auto refused = [&](const std::string& tool) { return refusal([&] { const Model model(settings(tool), mesh); }); };
  EXPECT_NE(refused("center: [0, 0, 0]").find("radius"), std::string::npos);
  EXPECT_NE(refused("radius: 0.01").find("center"), std::string::npos);
  EXPECT_NE(refused("radius: 0.01, center: [0, 0, 0], flat: true").find("end"), std::string::npos);
  EXPECT_NE(refused("radius: 0, center: [0, 0, 0]").find("> 0 m"), std::string::npos);
  const WrittenFile box("box.obj", box_in_millimetres()), open("open.obj", box_in_millimetres(5));
  EXPECT_NE(refused(surface(box) + ", radius: 0.01").find("no `radius` beside `surface`"), std::string::npos);
  EXPECT_NE(refused(surface(open, ", scale: 0.001")).find("open.obj"), std::string::npos);
  EXPECT_NE(refused("surface: {file: nowhere.stl}").find("nowhere.stl"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
