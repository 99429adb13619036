// A measured force, with or without its torque, on a patch and at points.
#include <gtest/gtest.h>

#include <cmath>

#include "../static_sag.hpp"
#include "body_forces.hpp"

namespace tissue_stiffness {
namespace {

TEST(Traction, ResultantIsTheMeasuredForce) {
  const TetMesh mesh = bar_mesh();
  Model model(box_settings({kInertia, kLinear, "traction: {region: tip, topic: /w, scale: 2}"}), mesh);
  Eigen::VectorXd wrench(6);
  wrench << 0.3, -0.2, 0.5, 9.0, 9.0, 9.0;
  model.loads().courses().at("/w")->add(0.0, wrench);
  const Eigen::VectorXd force = load(model, 0.0, zero(model));
  const Eigen::Vector3d expected = 2.0 * wrench.head<3>();
  EXPECT_LT((resultant(force) - expected).norm(), 1e-13);
  const Eigen::Vector3d centre(0.1, 0.01, 0.01);  // spread evenly: no torque about the patch's centre
  EXPECT_LT((moment(mesh, zero(model), force) - centre.cross(expected)).norm(), 1e-13);
}

// The sensor is above the patch and beside it, so its force turns the body, too.
TEST(Traction, HasTheTorqueThatIsMeasuredAboutTheSensor) {
  const TetMesh mesh = bar_mesh();
  for (const std::string region : {"tip", "corners"}) {
    ModelSettings settings = box_settings(
        {kInertia, kLinear, "traction: {region: " + region + ", topic: /w, scale: 2, torque_about: [0.13, 0.0, 0.04]}"});
    VertexShape corners;
    for (int v = 0; v < mesh.corner_count; ++v) {
      if (mesh.nodes(0, v) > 0.0999 && mesh.nodes.col(v).tail<2>().sum() < 0.03) corners.vertices.push_back(v);
    }
    ASSERT_EQ(corners.vertices.size(), 3U);
    settings.regions.push_back({"corners", corners});
    Model model(settings, mesh);
    Eigen::VectorXd wrench(6);
    wrench << 0.3, -0.2, 0.5, 0.02, 0.01, -0.03;
    model.loads().courses().at("/w")->add(0.0, wrench);
    const Eigen::VectorXd force = load(model, 0.0, zero(model));
    EXPECT_LT((resultant(force) - 2.0 * wrench.head<3>()).norm(), 1e-12) << region;
    const Eigen::Vector3d about(0.13, 0.0, 0.04);
    EXPECT_LT((moment(mesh, zero(model), force) - about.cross(resultant(force)) - 2.0 * wrench.tail<3>()).norm(), 1e-12)
        << region;
  }
}

// A bar of side a and length L takes the twist T L / (0.1406 G a^4) (Saint-Venant), and its axis bends with the
// curvature M / (E a^4 / 12), where neither end is near.
TEST(Traction, TwistsAndBendsABarAsBeamTheorySays) {
  const TetMesh mesh = bar_mesh(15, 3, 3);
  const auto at = [&](const Eigen::VectorXd& u, double x, double y, double z) {
    Eigen::Index node = 0;
    (mesh.nodes.colwise() - Eigen::Vector3d(x, y, z)).colwise().squaredNorm().minCoeff(&node);
    EXPECT_LT((mesh.nodes.col(node) - Eigen::Vector3d(x, y, z)).norm(), 1e-6);
    return Eigen::Vector3d(u.segment<3>(3 * node));
  };
  const auto moved = [&](const Eigen::Vector3d& torque) {
    Model model(box_settings({kInertia, kLinear, "fixed: {region: clamp}",
                              "traction: {region: tip, topic: /w, torque_about: [0.1, 0.01, 0.01]}"}),
                mesh);
    Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
    wrench.tail<3>() = torque;
    model.loads().courses().at("/w")->add(0.0, wrench);
    return static_sag(model);
  };
  const double torque = 1e-4, a4 = std::pow(0.02, 4), shear = 3.0e4 / 2.8;
  const double low = 0.04, high = 0.06;
  const Eigen::VectorXd twisted = moved({torque, 0, 0});
  const auto angle = [&](double x) { return (at(twisted, x, 0.01, 0.02).y() - at(twisted, x, 0.01, 0.0).y()) / -0.02; };
  const double twist = torque / (0.1406 * shear * a4) * (high - low);
  EXPECT_NEAR(angle(high) - angle(low), twist, 0.01 * twist);
  const Eigen::VectorXd bent = moved({0, torque, 0});
  const auto slope = [&](double x) { return (at(bent, x, 0.01, 0.02).x() - at(bent, x, 0.01, 0.0).x()) / 0.02; };
  const double turn = torque / (3.0e4 * a4 / 12.0) * (high - low);
  EXPECT_NEAR(slope(high) - slope(low), turn, 0.01 * turn);
}

TEST(Traction, NeedsMoreThanALineToTakeATorque) {
  const TetMesh mesh = bar_mesh();
  VertexShape line;
  for (int v = 0; v < mesh.corner_count; ++v) {
    if (mesh.nodes(0, v) > 0.0999 && mesh.nodes(2, v) < 1e-6) line.vertices.push_back(v);
  }
  ASSERT_EQ(line.vertices.size(), 2U);
  ModelSettings settings =
      box_settings({kInertia, kLinear, "traction: {region: line, topic: /w, torque_about: [0.1, 0.0, 0.0]}"});
  settings.regions.push_back({"line", line});
  EXPECT_NE(refusal([&] { Model(settings, mesh); }).find("neither a point nor a line"), std::string::npos);
}

// Far from where it acts, a force bends the body alike, be it spread over the tip or at two points beside its middle.
TEST(Traction, ActsAtPointsThatHoldNoFacet) {
  const TetMesh mesh = bar_mesh(8, 2, 2);
  VertexShape sides, inside;
  for (int v = 0; v < mesh.corner_count; ++v) {
    const Eigen::Vector3d x = mesh.nodes.col(v);
    if (x[0] > 0.0999 && std::abs(std::abs(x[1] - 0.01) - 0.01) < 1e-6 && std::abs(x[2] - 0.01) < 1e-6)
      sides.vertices.push_back(v);
    if ((x - Eigen::Vector3d(0.05, 0.01, 0.01)).norm() < 1e-6) inside.vertices.push_back(v);
  }
  ASSERT_EQ(sides.vertices.size(), 2U);
  ASSERT_EQ(inside.vertices.size(), 1U);
  const auto sag = [&](const std::string& region) {
    ModelSettings settings =
        box_settings({kInertia, kLinear, "fixed: {region: clamp}", "traction: {region: " + region + ", topic: /w}"});
    settings.regions.push_back({"sides", sides});
    settings.regions.push_back({"inside", inside});
    Model model(settings, mesh);
    Eigen::VectorXd wrench = Eigen::VectorXd::Zero(6);
    wrench[2] = -0.01;
    model.loads().courses().at("/w")->add(0.0, wrench);
    EXPECT_NEAR(resultant(ModelSystem(model, prior(model)).force(0.0, zero(model), zero(model)))[2], -0.01, 1e-15);
    return Eigen::VectorXd(static_sag(model).segment(3 * inside.vertices.front(), 3));
  };
  const Eigen::VectorXd spread = sag("tip");
  EXPECT_LT((sag("sides") - spread).norm(), 1e-3 * spread.norm());
  EXPECT_NE(refusal([&] { sag("inside"); }).find("or vertices of the surface"), std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
