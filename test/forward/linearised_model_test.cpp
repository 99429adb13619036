// Sensitivities about a run of large motion against differences of runs in full.
#include "forward/linearised_model.hpp"

#include <gtest/gtest.h>

#include "../box_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFrame = 1.0 / 30.0;
constexpr int kFrames = 16, kSteps = 24;

struct Case {
  std::string name;
  std::vector<std::string> effects;  ///< the last parameter that is estimated is theirs, absent at the prior
  double step;                       ///< of that parameter, for differences of runs in full (second order, one-sided)
  double most = 0.03;                ///< error, as a share. Accelerations and rates ring more than few vectors hold
};
void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

class Linearised : public testing::TestWithParam<Case> {
 protected:
  Linearised() : model_(box_settings(effects()), bar_mesh(6, 2, 2)) {
    for (const auto& [topic, course] : model_.loads().courses()) {
      course->add(0.0, Eigen::VectorXd::Zero(course->components()));
      course->add(0.3, 0.02 * Eigen::VectorXd::LinSpaced(course->components(), 1.0, 2.0));
      course->add(1.0, Eigen::VectorXd::Zero(course->components()));
    }
    for (int k = 1; k <= kFrames * kSteps; ++k) times_.push_back(kFrame * k / kSteps);
  }
  static std::vector<std::string> effects() {
    std::vector<std::string> list{
        "inertia: {density: 1000}", "fixed: {region: clamp}", "traction: {region: tip, topic: /push}",
        "elasticity: {law: neo_hookean, poisson_ratio: 0.45, young_modulus: {prior: 20e3, factor: 2}}"};
    list.insert(list.end(), GetParam().effects.begin(), GetParam().effects.end());
    return list;
  }
  Eigen::VectorXd moved(double share) const {
    Eigen::VectorXd w = model_.parameters().prior_mean();
    w[w.size() - 1] += share * GetParam().step;
    return model_.parameters().theta(w);
  }
  std::vector<DynamicState> run(double share) const {
    FullModel::Options options;
    options.steps_per_frame = 1;
    options.tolerance = 1e-10;
    return FullModel(model_, options).states(moved(share), 0.0, times_, [] {});
  }

  Model model_;
  std::vector<double> times_;
};

TEST_P(Linearised, AnswersAsRunsInFullDo) {
  const std::vector<DynamicState> middle = run(0.0), once = run(1.0), twice = run(2.0);
  const LinearisedModel linearised(model_, moved(0.0), middle, moved(0.01) - moved(0.0), {});
  EXPECT_GT(middle[10 * kSteps].displacement.lpNorm<Eigen::Infinity>(), 0.03);
  const auto still = linearised.start(moved(0.0), 0.0), with = linearised.start(moved(1.0), 0.0);
  double off = 0.0, all = 0.0;
  for (std::size_t k = 0; k < times_.size(); ++k) {
    still->advance(times_[k]);
    with->advance(times_[k]);
    EXPECT_NEAR((still->displacement() - middle[k + 1].displacement).norm(), 0.0, 1e-12);
    const Eigen::VectorXd wanted = 2.0 * once[k + 1].displacement - 0.5 * twice[k + 1].displacement -
                                   1.5 * middle[k + 1].displacement,
                          got = with->displacement() - still->displacement();
    off += (got - wanted).squaredNorm();
    all += wanted.squaredNorm();
  }
  RecordProperty("off", std::to_string(std::sqrt(off / all)));
  EXPECT_LT(std::sqrt(off / all), GetParam().most) << "of " << std::sqrt(all);
}

INSTANTIATE_TEST_SUITE_P(
    Parameters, Linearised,
    testing::Values(Case{"modulus", {}, 5e-4},
                    Case{"acceleration", {"gravity: {acceleration: {mean: [0, 0, 0], std: 1}}"}, 0.02},
                    Case{"damping", {"viscous_damping: {beta: {mean: 0, std: 1e-2}}"}, 5e-5, 0.06},
                    Case{"mass_damping", {"mass_damping: {alpha: {mean: 0, std: 1}}"}, 0.02},
                    Case{"relaxing", {"viscoelasticity: {gamma: {mean: 0, std: 1}, tau: 0.1}"}, 5e-4},
                    Case{"mass", {"added_mass: {region: far, mass: {mean: 0, std: 1e-2}}"}, 5e-6, 0.12},
                    Case{"ogden", {"ogden: {exponent: {mean: 2, std: 5}}"}, 0.01},
                    Case{"stiffening", {"strain_stiffening: {exponent: {mean: 0, std: 10}}"}, 2e-3},
                    Case{"compressible", {"compressibility: {shift: {mean: 0, std: 0.1}}"}, 2e-4},
                    Case{"load", {"force_scale: {relative: {mean: 0, std: 0.5}}"}, 0.02},
                    Case{
                        "pressure",
                        {"pressure: {region: top, topic: /p, scale: -100}", "force_scale: {relative: {mean: 0, std: 0.5}}"},
                        0.02},
                    Case{"inclusion",
                         {"stiff_inclusion: {center: [0.03, 0.01, 0.01], radius: 0.015, excess: {mean: 0, std: 1}}"},
                         0.02}),
    [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace tissue_stiffness
