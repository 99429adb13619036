// Steps of the full model that renew no factor ask the heap for nothing.
#include "heap/heap.hpp"

#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <memory>

#include "../box_model.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kStep = 0.008;
constexpr int kWarm = 12, kSteps = 40;

struct Case {
  std::string name;
  std::vector<std::string> effects;
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

std::string elasticity(const std::string& law) {
  return "elasticity: {law: " + law + ", poisson_ratio: 0.45, young_modulus: {prior: 40e3, factor: 2}}";
}

class HeapInSteps : public testing::TestWithParam<Case> {
 protected:
  HeapInSteps() : model_(box_settings(effects()), bar_mesh(10, 3, 3)) {
    for (const auto& [topic, course] : model_.loads().courses()) {
      course->add(0.0, Eigen::VectorXd::Zero(course->components()));
      course->add(1.0, Eigen::VectorXd::Constant(course->components(), 500.0));
    }
    std::vector<const DynamicSystem*> views;
    for (const double modulus : {90e3, 92e3, 110e3}) {
      const double w = model_.parameters().free().front().to_coordinate(modulus);
      systems_.push_back(std::make_unique<ModelSystem>(model_, model_.parameters().theta(Eigen::VectorXd::Constant(1, w))));
      views.push_back(systems_.back().get());
    }
    stepper_ = std::make_unique<GeneralizedAlpha>(views, 0.9, 1e-7);
    DynamicState rest;
    rest.displacement = rest.velocity = Eigen::VectorXd::Zero(model_.fem().dof_count());
    states_.assign(systems_.size(), rest);
    stepper_->initialise(states_);
  }

  void take_steps() {
    const std::vector<double> steps(states_.size(), kStep);
    for (int k = 0; k < kSteps; ++k) {
      const int factors = stepper_->factorisations();
      const Heap before = heap();
      stepper_->step(states_, steps);
      const Heap after = heap();
      moved_ = std::max(moved_, states_.front().displacement.cwiseAbs().maxCoeff());
      if (k < kWarm || stepper_->factorisations() > factors) continue;
      ++watched_;
      EXPECT_EQ(after.requests, before.requests) << "step " << k << ", " << after.bytes - before.bytes << " bytes";
    }
  }

  static std::vector<std::string> effects() {
    std::vector<std::string> list{"inertia: {density: 1000}", "fixed: {region: clamp}",
                                  "gravity: {acceleration: [0.5, 1, -9.81]}"};
    list.insert(list.end(), GetParam().effects.begin(), GetParam().effects.end());
    return list;
  }

  Model model_;
  std::vector<std::unique_ptr<ModelSystem>> systems_;
  std::unique_ptr<GeneralizedAlpha> stepper_;
  std::vector<DynamicState> states_;
  int watched_ = 0;
  double moved_ = 0.0;
};

TEST_P(HeapInSteps, IsLeftAlone) {
  tbb::task_arena one_core(1);  // how many buffers are in use at once is then no matter of chance
  one_core.execute([&] { take_steps(); });
  EXPECT_GT(watched_, kSteps / 8);
  EXPECT_GT(moved_, 1e-3) << "the bar hardly moved";
}

INSTANTIATE_TEST_SUITE_P(
    Models, HeapInSteps,
    testing::Values(
        Case{"neo_hookean", {elasticity("neo_hookean"), "mass_damping: {alpha: 0.5}"}},
        Case{"relaxing",
             {elasticity("neo_hookean"), "viscoelasticity: {gamma: 0.3, tau: 0.05}", "viscous_damping: {beta: 1e-3}"}},
        Case{"linear", {elasticity("linear")}},
        Case{"half_finite", {elasticity("linear"), "geometric_nonlinearity: {share: 0.5}"}},
        Case{"contact",
             {elasticity("linear"), "contact_plane: {point: [0, 0, -0.0005], normal: [0, 0, 1], stiffness: 3e5}"}},
        Case{"pressure", {elasticity("neo_hookean"), "pressure: {region: top, topic: /pressure}"}},
        Case{"fibres",
             {elasticity("neo_hookean"), "fibre_reinforcement: {direction: [1, 0, 0], modulus: 1e4}",
              "active_contraction: {direction: [1, 0, 0], amplitude: 1e3}"}},
        Case{"stiffening", {elasticity("linear"), "strain_stiffening: {exponent: 5}"}},
        Case{
            "finite_stiffening",
            {elasticity("neo_hookean"), "strain_stiffening: {exponent: 5}",
             "stiff_inclusion: {center: [0.05, 0.01, 0.01], radius: 0.008, excess: 1}", "compressibility: {shift: 0.01}"}}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace tissue_stiffness
