#include "nodes/live_options.hpp"

#include <utility>
#include <vector>

#include "nodes/node_keys.hpp"

namespace tissue_stiffness {
namespace {

const std::vector<std::pair<std::string, double EstimatorConfig::*>>& members() {
  static const std::vector<std::pair<std::string, double EstimatorConfig::*>> list{
      {"diagnosis_period", &EstimatorConfig::diagnosis_period},
      {"diagnosis_window", &EstimatorConfig::diagnosis_window},
      {"converged_within", &EstimatorConfig::converged_within},
      {"stale_after", &EstimatorConfig::stale_after},
      {"colour_limit", &EstimatorConfig::colour_limit}};
  return list;
}

const KeySpec& key(const std::string& name) {
  return find_key(node_keys("estimator_node"), name);
}

EstimatorConfig config_of(double KeySpec::*end) {
  EstimatorConfig out = EstimatorConfig::__getDefault__();
  for (const auto& [name, member] : members()) out.*member = key(name).*end;
  return out;
}

}  // namespace

LiveOptions read_live_options(const Value& own, double stale_after) {
  const auto number = [&](const std::string& name) { return read_number(own, key(name)); };
  LiveOptions out;
  out.check = {number("diagnosis_period"), number("diagnosis_window")};
  out.limits.converged_within = number("converged_within");
  out.limits.stale_after = own.has("stale_after") ? number("stale_after") : stale_after;
  out.colour_limit = number("colour_limit");
  return out;
}

LiveOptions to_live_options(const EstimatorConfig& config, const std::string& where) {
  std::vector<std::pair<std::string, Value>> entries;
  for (const auto& [name, member] : members()) {
    entries.emplace_back(name, Value::number(config.*member, where + ": " + name));
  }
  return read_live_options(Value::map(std::move(entries), where), config.stale_after);
}

EstimatorConfig to_config(const LiveOptions& options) {
  EstimatorConfig out = EstimatorConfig::__getDefault__();
  out.diagnosis_period = options.check.period;
  out.diagnosis_window = options.check.window;
  out.converged_within = options.limits.converged_within;
  out.stale_after = options.limits.stale_after;
  out.colour_limit = options.colour_limit;
  return out;
}

EstimatorConfig least_config() {
  return config_of(&KeySpec::lower);
}

EstimatorConfig largest_config() {
  return config_of(&KeySpec::upper);
}

}  // namespace tissue_stiffness
