// The static response to forces at single nodes: against a solution of the whole body.
#include "forward/nodal_flexibility.hpp"

#include <gtest/gtest.h>

#include "../box_model.hpp"
#include "forward/model.hpp"

namespace tissue_stiffness {
namespace {

class Held : public testing::Test {
 protected:
  Held()
      : model_(
            box_settings({"inertia: {density: 1000}", "elasticity: {law: linear, young_modulus: 2.0e4, poisson_ratio: 0.4}",
                          "fixed: {region: clamp}"}),
            bar_mesh(2)),
        theta_(model_.prior_theta()),
        stiffness_(model_.rest_stiffness(theta_)) {
    for (int i = 0; i < 30; ++i) seen_.push_back(static_cast<int>(stiffness_.rows()) - 31 + i);
  }
  Model model_;
  Eigen::VectorXd theta_;
  SparseMatrix stiffness_;
  std::vector<int> seen_;
};

TEST_F(Held, ColumnsSolveTheBalance) {
  const NodalFlexibility flexibility(stiffness_, model_.fixed(), seen_);
  const std::vector<int> forced{3, 7, 20};
  const Eigen::Vector3d forces(0.1, -0.2, 0.05);
  Eigen::VectorXd all = Eigen::VectorXd::Zero(30), load = Eigen::VectorXd::Zero(stiffness_.rows());
  for (int k = 0; k < 3; ++k) {
    all[forced[static_cast<std::size_t>(k)]] = forces[k];
    load[seen_[static_cast<std::size_t>(forced[static_cast<std::size_t>(k)])]] = forces[k];
  }
  const Eigen::VectorXd u = flexibility.response(all), under = flexibility.under(forced, forces);
  const Eigen::VectorXd balance = stiffness_ * u - load;
  for (Eigen::Index i = 0; i < u.size(); ++i) {
    if (model_.fixed()[static_cast<std::size_t>(i)] != 0) {
      EXPECT_EQ(u[i], 0.0);
    } else {
      EXPECT_NEAR(balance[i], 0.0, 1e-9);
    }
  }
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(under[i], u[seen_[static_cast<std::size_t>(i)]], 1e-12 * u.norm());
  const Eigen::VectorXd between = flexibility.between(forced) * forces;
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(between[k], under[forced[static_cast<std::size_t>(k)]], 1e-12 * u.norm());
}

TEST_F(Held, KnowsAStiffnessInProportion) {
  const NodalFlexibility flexibility(stiffness_, model_.fixed(), seen_);
  EXPECT_NEAR(flexibility.ratio(SparseMatrix(2.5 * stiffness_), model_.fixed()), 2.5, 1e-12);
  SparseMatrix other = stiffness_;
  other.coeffRef(40, 40) *= 1.001;
  EXPECT_EQ(flexibility.ratio(other, model_.fixed()), 0.0);
  std::vector<char> less = model_.fixed();
  std::fill(less.begin(), less.end(), char{0});
  EXPECT_EQ(flexibility.ratio(stiffness_, less), 0.0);
}

}  // namespace
}  // namespace tissue_stiffness
