#include "effects/load_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "effects/course.hpp"

namespace tissue_stiffness {
namespace {

Eigen::VectorXd ramp(double time) {
  return Eigen::Vector3d(0.0, 2.0 * time, -4.0 * time);
}

LoadTolerance only(double LoadTolerance::*which, double std) {
  LoadTolerance out{0, 0, 0, 0.5, 0, 0, 0};
  out.*which = std;
  return out;
}

TEST(LoadErrorBasis, HasTheColumnsOfEachError) {
  const auto column = [](double LoadTolerance::*which, double std) {
    return LoadErrorBasis(only(which, std), ramp, 3, 0.0, 2.0).value(ramp, 1.0);
  };
  EXPECT_TRUE(column(&LoadTolerance::gain, 0.1).isApprox(0.1 * ramp(1.0)));
  EXPECT_TRUE(column(&LoadTolerance::bias, 0.3).isApprox(0.3 * Eigen::Matrix3d::Identity()));
  EXPECT_TRUE(column(&LoadTolerance::delay, 0.01).isApprox(-0.01 * Eigen::Vector3d(0, 2, -4)));
  const Eigen::MatrixXd hysteresis = column(&LoadTolerance::hysteresis, 0.2);
  EXPECT_NEAR(hysteresis(1, 1), 0.2, 1e-3);
  EXPECT_NEAR(hysteresis(2, 2), -0.2, 1e-3);
  const Eigen::MatrixXd turned = column(&LoadTolerance::direction, 0.05);
  EXPECT_TRUE(turned.col(0).isApprox(0.05 * Eigen::Vector3d(0, 4, 2)));  // e_x x (0, 2, -4)
}

TEST(LoadErrorBasis, NoiseHasTheStatedVarianceAndMemory) {
  const LoadErrorBasis basis(only(&LoadTolerance::noise, 0.2), ramp, 3, 0.0, 2.0);
  const Eigen::MatrixXd now = basis.value(ramp, 1.0), later = basis.value(ramp, 1.5);
  EXPECT_NEAR((now * now.transpose())(0, 0), 0.04, 0.002);
  EXPECT_NEAR((now * later.transpose())(0, 0), 0.04 * std::exp(-1.0), 0.002);
  EXPECT_NEAR((now * now.transpose())(0, 1), 0.0, 1e-12);
}

TEST(LoadErrorBasis, SharesAreOfTheLargestLoad) {
  const LoadErrorBasis basis(only(&LoadTolerance::bias, -0.1), ramp, 3, 0.0, 2.0);
  EXPECT_NEAR(basis.groups().front().std, 0.1 * ramp(2.0).norm(), 1e-9);
  EXPECT_TRUE(only(&LoadTolerance::bias, 0.0).exact());
}

Eigen::VectorXd wrench_ramp(double time) {
  return (Eigen::VectorXd(6) << ramp(time), 0.01 * time, 0.0, -0.02 * time).finished();
}

// Gain, delay and direction are of the sensor, so force and torque share them. The others have a size of their own.
TEST(LoadErrorBasis, HasErrorsOfTheTorque) {
  const auto basis = [](double LoadTolerance::*which, double std) {
    return LoadErrorBasis(only(which, std), wrench_ramp, 6, 0.0, 2.0);
  };
  const auto column = [&](double LoadTolerance::*which, double std) { return basis(which, std).value(wrench_ramp, 1.0); };
  EXPECT_TRUE(column(&LoadTolerance::gain, 0.1).isApprox(0.1 * wrench_ramp(1.0)));
  EXPECT_TRUE(column(&LoadTolerance::delay, 0.01).isApprox(-0.01 * wrench_ramp(1.0)));
  const Eigen::MatrixXd turned = column(&LoadTolerance::direction, 0.05);
  EXPECT_TRUE(turned.block(0, 0, 3, 1).isApprox(0.05 * Eigen::Vector3d(0, 4, 2)));
  EXPECT_TRUE(turned.block(3, 0, 3, 1).isApprox(0.05 * Eigen::Vector3d(0, 0.02, 0)));  // e_x x (0.01, 0, -0.02)
  const LoadErrorBasis of_force = basis(&LoadTolerance::bias, 0.3), of_torque = basis(&LoadTolerance::torque_bias, -0.1);
  EXPECT_TRUE(of_force.value(wrench_ramp, 1.0).isApprox(0.3 * Eigen::MatrixXd::Identity(6, 3)));
  ASSERT_EQ(of_torque.groups().size(), 1U);
  const LoadErrorBasis::Group group = of_torque.groups().front();
  EXPECT_EQ(group.name + " " + group.unit, "torque bias N m");
  EXPECT_NEAR(group.std, 0.1 * wrench_ramp(2.0).tail<3>().norm(), 1e-12);
  EXPECT_TRUE(of_torque.value(wrench_ramp, 1.0).bottomRows(3).isApprox(group.std * Eigen::Matrix3d::Identity()));
  EXPECT_TRUE(of_torque.value(wrench_ramp, 1.0).topRows(3).isZero());
  const Eigen::MatrixXd noise = column(&LoadTolerance::torque_noise, 0.2);
  EXPECT_NEAR((noise * noise.transpose())(4, 4), 0.04, 0.002);
  EXPECT_TRUE(noise.topRows(3).isZero());
  const Eigen::MatrixXd hysteresis = column(&LoadTolerance::torque_hysteresis, 0.2);
  EXPECT_NEAR(hysteresis(5, 2), -0.2, 1e-3);
}

TEST(Course, TakesAnErrorOffTheSamplesAndThoseToCome) {
  Course course(LoadInput::Kind::wrench);
  const auto sample = [](double time) {
    Eigen::VectorXd value = Eigen::VectorXd::Zero(6);
    value.head<3>() = ramp(time);
    return value;
  };
  for (int k = 0; k <= 10; ++k) course.add(0.1 * k, sample(0.1 * k));
  course.correct(LoadErrorBasis(only(&LoadTolerance::bias, 0.5), ramp, 3, 0.0, 1.0), Eigen::Vector3d(0, 2, 0));
  EXPECT_NEAR(course.value(0.5, 1), 1.0 - 1.0, 1e-12);
  EXPECT_NEAR(course.measured(0.5, 1), 1.0, 1e-12);
  course.add(1.1, sample(1.1));
  EXPECT_NEAR(course.value(1.1, 1), 2.2 - 1.0, 1e-12);
  course.correct({}, {});
  EXPECT_NEAR(course.value(0.5, 1), 1.0, 1e-12);
  EXPECT_NEAR(*course.last(), 1.1, 1e-12);
}

}  // namespace
}  // namespace tissue_stiffness
