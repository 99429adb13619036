#include "diagnosis/mix_explanations.hpp"

#include <algorithm>
#include <cmath>

#include "filter/consistency.hpp"
#include "filter/interval.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFar = 12.0;  // standard deviations within which a mixture's quantiles are searched
constexpr int kHalvings = 60;

struct Component {
  double shift, weight;  ///< of the logarithm's mean
};

std::vector<Component> components_of(const std::vector<std::vector<RivalExplanation>>& rivals, const std::string& name) {
  std::vector<Component> out{{0.0, 1.0}};
  for (const std::vector<RivalExplanation>& addition : rivals) {
    double added = 1.0;
    for (const RivalExplanation& rival : addition) added -= rival.probability;
    std::vector<Component> product;
    for (const Component& c : out) {
      product.push_back({c.shift, c.weight * added});
      for (const RivalExplanation& rival : addition) {
        const auto ratio = rival.modulus_ratio.find(name);
        const double shift = ratio != rival.modulus_ratio.end() ? std::log(ratio->second) : 0.0;
        product.push_back({c.shift + shift, c.weight * rival.probability});
      }
    }
    out = std::move(product);
  }
  return out;
}

double quantile(const std::vector<Component>& components, double mean, double std, double share) {
  const auto [least, most] = std::minmax_element(components.begin(), components.end(),
                                                 [](const auto& a, const auto& b) { return a.shift < b.shift; });
  double low = mean + least->shift - kFar * std, high = mean + most->shift + kFar * std;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = 0.5 * (low + high);
    double below = 0.0;
    for (const Component& c : components) {
      below += c.weight * normal_cdf((middle - mean - c.shift) / std);
    }
    (below < share ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace

void mix_explanations(const std::vector<std::vector<RivalExplanation>>& rivals,
                      std::vector<ParameterEstimate>& parameters) {
  for (ParameterEstimate& p : parameters) {
    if (!is_young_modulus(p.name) || !(p.lower95 > 0.0) || !(p.upper95 > p.lower95)) continue;
    const std::vector<Component> components = components_of(rivals, p.name);
    if (components.size() < 2) continue;
    const double mean = 0.5 * std::log(p.upper95 * p.lower95),
                 std = std::log(p.upper95 / p.lower95) / (2.0 * normal_quantile_975);
    double first = 0.0, second = 0.0;  // moments of E over those of the added explanation alone
    for (const Component& c : components) {
      first += c.weight * std::exp(c.shift);
      second += c.weight * std::exp(2.0 * c.shift);
    }
    const double square = second * (p.mean * p.mean + p.std * p.std);
    p.mean *= first;
    p.std = std::sqrt(std::max(0.0, square - p.mean * p.mean));
    p.lower95 = std::exp(quantile(components, mean, std, 0.025));
    p.upper95 = std::exp(quantile(components, mean, std, 0.975));
  }
}

}  // namespace tissue_stiffness
