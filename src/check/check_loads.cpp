#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "check/check_motion.hpp"
#include "check/words.hpp"
#include "effects/registry.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kUpper = 2.0;          // prior standard deviations: its upper 2.5 %
constexpr double kStep = 0.5;           // the same, between the moduli that are tried
constexpr double kHalf = 0.5;           // of the motion's power
constexpr double kSofterThan = 1000.0;  // [Pa] a modulus that is more likely in kPa than a load in mN

double mean_square(const Eigen::VectorXd& v) {
  return v.squaredNorm() / static_cast<double>(std::max<Eigen::Index>(v.size(), 1));
}

/// Returns the parts of the motion at one modulus: a column for each load, and the last for everything else.
Eigen::MatrixXd parts(const MotionStudy& study, double z) {
  const std::vector<std::size_t>& loads = study.loads();
  const Eigen::VectorXd whole = study.predicted(z);
  Eigen::MatrixXd out(whole.size(), static_cast<Eigen::Index>(loads.size()) + 1);
  out.rightCols<1>() = whole;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    out.col(column) = whole - study.predicted(z, static_cast<std::ptrdiff_t>(loads[i]));
    out.rightCols<1>() -= out.col(column);
  }
  return out;
}

struct Factors {
  Eigen::VectorXd values;
  double left;  ///< |m - parts values|^2
};

Factors fit(const Eigen::MatrixXd& parts, const Eigen::VectorXd& measured) {
  const Eigen::VectorXd values = parts.completeOrthogonalDecomposition().solve(measured);
  return {values, (measured - parts * values).squaredNorm()};
}

Eigen::MatrixXd without(Eigen::MatrixXd parts, Eigen::Index column) {
  parts.col(column).setZero();
  return parts;
}

std::string topic_of(const EffectSettings& effect) {
  const EffectSettings copy = effect;  // asking marks keys as known
  for (const char* key : {"topic", "course"}) {
    if (copy.arguments.has(key)) return key == std::string("topic") ? copy.arguments.at(key).as_text() : effect.label;
  }
  return effect.label;
}

bool is_force(const EffectSettings& effect) {
  return effect_spec(effect).load == LoadInput::Kind::wrench;
}

SetupFindings check_signs(const MotionStudy& study, const ModelSettings& settings) {
  const Eigen::VectorXd& measured = study.measured();
  if ((measured - study.predicted(study.best_modulus())).squaredNorm() < kHalf * measured.squaredNorm()) return {};
  std::optional<Factors> best;
  Eigen::MatrixXd there;
  const double range = study.modulus_is_free() ? kUpper : 0.0;
  for (double z = -range; z <= range; z += kStep) {
    const Eigen::MatrixXd now = parts(study, z);
    const Factors factors = fit(now, measured);
    if (best && factors.left >= best->left) continue;
    best = factors;
    there = now;
  }
  SetupFindings findings;
  for (std::size_t i = 0; i < study.loads().size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    const double left = fit(without(there, column), measured).left;
    if (best->values[column] >= 0.0 || left - best->left <= kHalf * left) continue;
    const EffectSettings& effect = settings.effects[study.loads()[i]];
    const std::string topic = topic_of(effect);
    findings.push_back(
        {topic, topic + ": the measured motion runs against the " + (is_force(effect) ? "force" : "pressure") +
                    " (correlation " + plain_number(-std::sqrt(1.0 - best->left / left), 2) +
                    " with the predicted motion, where a positive one is expected); " +
                    (is_force(effect) ? "the wrench has to be the force on the body, in the direction of its header's frame"
                                      : "a positive pressure pushes on the tissue") +
                    ", so turn its sign, as `scale: -1` of `" + effect.name + "` does."});
  }
  return findings;
}

SetupFinding wrong_load(const EffectSettings& effect, const std::string& beside) {
  const std::string topic = topic_of(effect), unit = is_force(effect) ? "N" : "Pa";
  return {topic, topic + ": " + beside + "; if the " + (is_force(effect) ? "force" : "pressure") + " is in m" + unit +
                     " where " + unit + " is expected, write `scale: 0.001` in `" + effect.name + "`."};
}

SetupFinding wrong_modulus(const EffectSettings& elasticity, const std::string& beside, double modulus) {
  const std::string key = elasticity.arguments.at("young_modulus").path();
  return {key, key + ": " + beside + "; if the modulus is in kPa where Pa is expected, write " +
                   plain_number(1e3 * modulus, 4) + "."};
}

SetupFindings check_units(const MotionStudy& study, const ModelSettings& settings) {
  const double seen = mean_square(study.measured());
  const Eigen::MatrixXd median = parts(study, 0.0);
  const double expected = mean_square(median.rowwise().sum());
  const double least = study.modulus_is_free() ? mean_square(study.predicted(kUpper)) : expected;
  if (expected <= kPrefixSlip * kPrefixSlip * seen || least <= seen) return {};
  const auto elasticity = std::find_if(settings.effects.begin(), settings.effects.end(),
                                       [](const EffectSettings& effect) { return effect.name == "elasticity"; });
  const EffectSettings copy = *elasticity;  // asking marks keys as known
  const double modulus = copy.arguments.at("young_modulus").as_quantity(0.0, 1e15, "Pa").value;
  const std::string beside = "with a modulus of " + plain_number(1e-3 * modulus, 4) + " kPa a motion of " +
                             millimetres(std::sqrt(expected)) + " rms is expected, " +
                             plain_number(std::sqrt(expected / seen), 2) + " times the measured one of " +
                             millimetres(std::sqrt(seen));
  Eigen::Index largest = 0;
  median.colwise().squaredNorm().maxCoeff(&largest);
  const bool by_load = largest + 1 < median.cols();
  if (!by_load || modulus < kSofterThan) return {wrong_modulus(copy, beside, modulus)};
  return {wrong_load(settings.effects[study.loads()[static_cast<std::size_t>(largest)]], beside)};
}

}  // namespace

SetupFindings check_loads(const MotionStudy& study, const ModelSettings& settings) {
  SetupFindings findings = check_units(study, settings);
  if (!study.loads().empty()) append(findings, check_signs(study, settings));
  return findings;
}

}  // namespace tissue_stiffness
