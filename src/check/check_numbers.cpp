#include "check/check_numbers.hpp"

#include <algorithm>
#include <array>
#include <limits>

#include "check/words.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSoftest = 100.0;  // [Pa] brain and fat have several hundred
constexpr double kStiffest = 1e9;   // [Pa] tendon; bone is no soft tissue
constexpr double kLightest = 5.0;   // [kg/m^3] the lightest foams have 6
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array<const char*, 5> kHolders = {"fixed", "elastic_support", "foundation", "contact_plane", "moved"};

/// Returns the value, median or mean of a number of the effect.
double central(const Value& value, const std::string& unit) {
  return value.as_quantity(-kInfinity, kInfinity, unit).value;
}

void check_modulus(const Value& arguments, SetupFindings& findings) {
  if (!arguments.has("young_modulus")) return;
  const Value& entry = arguments.at("young_modulus");
  const double modulus = central(entry, "Pa");
  if (!(modulus > 0.0) || modulus >= kSoftest) return;
  findings.push_back({entry.path(), entry.path() + ": a modulus of " + plain_number(modulus) +
                                        " Pa is softer than any tissue, which has " + plain_number(kSoftest) + " Pa to " +
                                        plain_number(1e-9 * kStiffest) + " GPa; if it is in kPa, write " +
                                        plain_number(1e3 * modulus) + "."});
}

void check_density(const Value& arguments, SetupFindings& findings) {
  if (!arguments.has("density")) return;
  const Value& entry = arguments.at("density");
  const double density = central(entry, "kg/m^3");
  if (!(density > 0.0) || density >= kLightest) return;
  findings.push_back({entry.path(), entry.path() + ": a density of " + plain_number(density) +
                                        " kg/m^3 is lighter than any foam, and tissue has about 1000 kg/m^3; if it is in "
                                        "g/cm^3, write " +
                                        plain_number(1e3 * density, 4) + "."});
}

bool holds_the_body(const EffectSettings& effect) {
  return std::any_of(kHolders.begin(), kHolders.end(), [&](const char* name) { return effect.name == name; });
}

}  // namespace

SetupFindings check_numbers(const ModelSettings& settings) {
  SetupFindings findings;
  for (EffectSettings effect : settings.effects) {  // a copy: asking marks keys as known
    if (effect.name == "elasticity") check_modulus(effect.arguments, findings);
    if (effect.name == "inertia") check_density(effect.arguments, findings);
  }
  if (std::none_of(settings.effects.begin(), settings.effects.end(), holds_the_body)) {
    findings.push_back({"effects",
                        "effects: nothing holds the body, which the loads will push away as a whole; add "
                        "`fixed: {region: ...}`, or a `foundation` or `contact_plane` that it rests on."});
  }
  return findings;
}

}  // namespace tissue_stiffness
