// The viscous stress of finite strain, of every effect that has one.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "../box_model.hpp"
#include "forward/full_model.hpp"
#include "forward/model.hpp"
#include "settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kBeta = 4e-3;

Eigen::VectorXd flat(const Eigen::Matrix3Xd& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), x.size());
}

/// A bar of neo-Hookean tissue with a stiff ball in it, which is damped.
class ViscousForm : public ::testing::TestWithParam<int> {
 protected:
  ViscousForm()
      : mesh_(make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, GetParam())),
        model_(
            box_settings({"inertia: {density: 1000}",
                          "elasticity: {law: neo_hookean, poisson_ratio: 0.3, young_modulus: {prior: 20.0e3, factor: 3}}",
                          "stiff_inclusion: {center: [0.03, 0.01, 0.01], radius: 0.01, excess: 2}",
                          "viscous_damping: {beta: 4.0e-3}", "fixed: {region: clamp}"}),
            mesh_),
        theta_(model_.parameters().theta(model_.parameters().prior_mean())),
        at_(model_.point(theta_)) {
    srand(1);
    u_ = 1e-3 * Eigen::Matrix3Xd::Random(3, mesh_.node_count());
    v_ = Eigen::Matrix3Xd::Random(3, mesh_.node_count());
    turn_ = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  }

  Eigen::VectorXd force(const Eigen::Matrix3Xd& u, const Eigen::Matrix3Xd& v) const {
    Eigen::VectorXd moving = Eigen::VectorXd::Zero(u.size()), still = moving;
    model_.add_nonlinear_force(at_, {0.0, flat(u), flat(v)}, moving);
    model_.add_nonlinear_force(at_, {0.0, flat(u), Eigen::VectorXd::Zero(u.size())}, still);
    return moving - still;
  }

  const TetMesh mesh_;
  const Model model_;
  const Eigen::VectorXd theta_;
  const Model::Point at_;
  Eigen::Matrix3Xd u_, v_;
  Eigen::Matrix3d turn_;
};

TEST_P(ViscousForm, IsTheLinearDampingOfABodyAtRest) {
  EXPECT_TRUE(model_.has_finite_damping(at_));
  EXPECT_EQ(model_.linear_reference_stiffness(theta_).coeffs().cwiseAbs().maxCoeff(), 0.0);
  const Eigen::VectorXd linear = -kBeta * (model_.reference_stiffness(theta_) * flat(v_));
  EXPECT_LT((force(Eigen::Matrix3Xd::Zero(3, u_.cols()), v_) - linear).norm(), 1e-12 * linear.norm());
}

TEST_P(ViscousForm, DoesNotDampABodyThatTurns) {
  const Eigen::Vector3d spin(3.0, -1.0, 2.0);
  const Eigen::Matrix3Xd turned = turn_ * mesh_.nodes;
  Eigen::Matrix3Xd velocity = -turned.colwise().cross(spin);
  velocity.colwise() += Eigen::Vector3d(0.2, 0.1, -0.3);
  const Eigen::VectorXd as_if_linear = kBeta * (model_.reference_stiffness(theta_) * flat(velocity));
  EXPECT_LT(force(turned - mesh_.nodes, velocity).norm(), 1e-12 * as_if_linear.norm());
}

TEST_P(ViscousForm, TurnsWithTheBody) {
  const Eigen::Vector3d spin(3.0, -1.0, 2.0);
  const Eigen::Matrix3Xd place = turn_ * (mesh_.nodes + u_);
  const Eigen::Matrix3Xd velocity = turn_ * v_ - place.colwise().cross(spin);
  const Eigen::VectorXd there = force(place - mesh_.nodes, velocity), here = force(u_, v_);
  const Eigen::Map<const Eigen::Matrix3Xd> plain(here.data(), 3, u_.cols());
  EXPECT_LT((there - flat(turn_ * plain)).norm(), 1e-10 * here.norm());
}

TEST_P(ViscousForm, TakesEnergyAndHasItsTangent) {
  EXPECT_LT(force(u_, v_).dot(flat(v_)), 0.0);
  SparseMatrix tangent = model_.fem().pattern();
  model_.add_velocity_tangent(at_, {0.0, flat(u_), flat(v_)}, tangent);
  const Eigen::VectorXd expected = -(tangent * flat(v_));  // the force is linear in the velocity
  EXPECT_LT((force(u_, v_) - expected).norm(), 1e-10 * expected.norm());
  EXPECT_LT((Eigen::MatrixXd(tangent) - Eigen::MatrixXd(tangent).transpose()).cwiseAbs().maxCoeff(),
            1e-12 * tangent.coeffs().cwiseAbs().maxCoeff());
}

TEST_P(ViscousForm, RelaxingBranchesTurnWithTheBody) {
  const Model relaxing(extend_model(model_.settings(), std::vector<std::string>{"viscoelasticity: {gamma: 0.5, tau: 0.1}"}),
                       mesh_);
  const ModelSystem system(relaxing, relaxing.parameters().theta(relaxing.parameters().prior_mean()));
  Eigen::VectorXd here, there, still, zero = Eigen::VectorXd::Zero(3 * mesh_.node_count());
  const Eigen::Matrix3Xd place = turn_ * (mesh_.nodes + u_);
  system.find_relaxing_strain(flat(u_), here);
  system.find_relaxing_strain(flat(place - mesh_.nodes), there);
  system.find_relaxing_strain(zero, still);
  EXPECT_EQ(still.norm(), 0.0);
  const Eigen::Index strains = here.size() - zero.size();
  EXPECT_LT((here - there).tail(strains).norm(), 1e-10 * here.tail(strains).norm());
  Eigen::VectorXd f = zero, turned = zero;
  system.subtract_relaxing_force(flat(u_), here, f);
  system.subtract_relaxing_force(flat(place - mesh_.nodes), there, turned);
  const Eigen::Map<const Eigen::Matrix3Xd> plain(f.data(), 3, u_.cols());
  EXPECT_GT(f.norm(), 0.0);
  EXPECT_LT((turned - flat(turn_ * plain)).norm(), 1e-10 * f.norm());
}

// A hardly moved body relaxes as linear branches do.
TEST_P(ViscousForm, RelaxingBranchesTendToTheLinearOnes) {
  const Model relaxing(extend_model(model_.settings(), std::vector<std::string>{"viscoelasticity: {gamma: 0.5, tau: 0.1}"}),
                       mesh_);
  const ModelSystem system(relaxing, relaxing.parameters().theta(relaxing.parameters().prior_mean()));
  const Eigen::VectorXd u = 1e-6 * flat(u_);
  Eigen::VectorXd strain, f = Eigen::VectorXd::Zero(u.size());
  system.find_relaxing_strain(u, strain);
  system.subtract_relaxing_force(u, strain, f);
  const Eigen::VectorXd linear = -(system.relaxing_stiffness() * u);
  EXPECT_LT((f - linear).norm(), 1e-5 * linear.norm());
}

INSTANTIATE_TEST_SUITE_P(Orders, ViscousForm, ::testing::Values(1, 2));

}  // namespace
}  // namespace tissue_stiffness
