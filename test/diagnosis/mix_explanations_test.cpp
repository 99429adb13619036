#include "diagnosis/mix_explanations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace tissue_stiffness {
namespace {

const std::string kName = "elasticity.young_modulus";

// log E ~ N(log 1e4, 0.05^2)
std::vector<ParameterEstimate> estimates() {
  const double spread = std::exp(1.959963984540054 * 0.05);
  return {{kName, "Pa", 1e4 * std::exp(0.5 * 0.05 * 0.05), 500.0, 1e4 / spread, 1e4 * spread},
          {"viscous_damping.beta", "s", 1e-3, 1e-4, 8e-4, 1.2e-3}};
}

TEST(MixExplanations, LeavesAloneWhatNoRivalDisagreesAbout) {
  for (const auto& rivals : {std::vector<std::vector<RivalExplanation>>{}, {{}}, {{{"fibres", 0.4, {{kName, 1.0}}}}}}) {
    std::vector<ParameterEstimate> mixed = estimates();
    mix_explanations(rivals, mixed);
    EXPECT_NEAR(mixed[0].mean, estimates()[0].mean, 1e-6 * mixed[0].mean);
    EXPECT_NEAR(mixed[0].lower95, estimates()[0].lower95, 1e-6 * mixed[0].mean);
    EXPECT_NEAR(mixed[0].upper95, estimates()[0].upper95, 1e-6 * mixed[0].mean);
  }
}

// The quantiles are compared with samples of the mixture.
TEST(MixExplanations, HasTheQuantilesOfTheMixture) {
  std::vector<ParameterEstimate> mixed = estimates();
  mix_explanations({{{"force_scale", 0.3, {{kName, 0.8}}}}, {{"gravity", 0.2, {{kName, 1.1}}}}}, mixed);
  std::mt19937 engine(1);
  std::normal_distribution<double> normal(std::log(1e4), 0.05);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> samples(200000);
  for (double& e : samples) {
    const double first = uniform(engine) < 0.3 ? 0.8 : 1.0, second = uniform(engine) < 0.2 ? 1.1 : 1.0;
    e = first * second * std::exp(normal(engine));
  }
  std::sort(samples.begin(), samples.end());
  double sum = 0.0;
  for (const double e : samples) sum += e;
  EXPECT_NEAR(mixed[0].mean, sum / static_cast<double>(samples.size()), 30.0);
  EXPECT_NEAR(mixed[0].lower95, samples[samples.size() / 40], 30.0);
  EXPECT_NEAR(mixed[0].upper95, samples[samples.size() - samples.size() / 40], 60.0);
  EXPECT_EQ(mixed[1].upper95, 1.2e-3) << "only moduli are mixed";
}

}  // namespace
}  // namespace tissue_stiffness
