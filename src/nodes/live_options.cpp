#include "nodes/live_options.hpp"

#include <utility>
#include <vector>

#include "nodes/node_keys.hpp"

namespace tissue_stiffness {
namespace {

/// An option by its name, in the message of dynamic_reconfigure and in LiveOptions.
struct Option {
  std::string name;
  double EstimatorConfig::*in_config;
  double& (*in)(LiveOptions&);
};

const std::vector<Option>& all_options() {
  static const std::vector<Option> list{
      {"diagnosis_period", &EstimatorConfig::diagnosis_period, [](LiveOptions& o) -> double& { return o.check.period; }},
      {"diagnosis_window", &EstimatorConfig::diagnosis_window, [](LiveOptions& o) -> double& { return o.check.window; }},
      {"converged_within", &EstimatorConfig::converged_within,
       [](LiveOptions& o) -> double& { return o.limits.converged_within; }},
      {"stale_after", &EstimatorConfig::stale_after, [](LiveOptions& o) -> double& { return o.limits.stale_after; }},
      {"colour_limit", &EstimatorConfig::colour_limit, [](LiveOptions& o) -> double& { return o.colour_limit; }}};
  return list;
}

const KeySpec& key(const std::string& name) {
  return find_key(node_keys("estimator_node"), name);
}

EstimatorConfig config_of(double KeySpec::*end) {
  EstimatorConfig out = EstimatorConfig::__getDefault__();
  for (const Option& option : all_options()) out.*option.in_config = key(option.name).*end;
  return out;
}

}  // namespace

LiveOptions read_live_options(const Value& own, double stale_after) {
  LiveOptions out;
  for (const Option& option : all_options()) {
    const bool of_model = option.name == "stale_after" && !own.has(option.name);
    option.in(out) = of_model ? stale_after : read_number(own, key(option.name));
  }
  return out;
}

LiveOptions to_live_options(const EstimatorConfig& config, const std::string& where) {
  std::vector<std::pair<std::string, Value>> entries;
  for (const Option& option : all_options()) {
    entries.emplace_back(option.name, Value::number(config.*option.in_config, where + ": " + option.name));
  }
  return read_live_options(Value::map(std::move(entries), where), config.stale_after);
}

EstimatorConfig to_config(LiveOptions options) {
  EstimatorConfig out = EstimatorConfig::__getDefault__();
  for (const Option& option : all_options()) out.*option.in_config = option.in(options);
  return out;
}

EstimatorConfig least_config() {
  return config_of(&KeySpec::lower);
}

EstimatorConfig largest_config() {
  return config_of(&KeySpec::upper);
}

}  // namespace tissue_stiffness
