#include "tissue_stiffness/settings/key_spec.hpp"

#include <algorithm>
#include <stdexcept>

namespace tissue_stiffness {

std::string KeySpec::name() const {
  return path.substr(path.rfind('.') + 1);
}

const KeySpec& find_key(const std::vector<KeySpec>& keys, const std::string& path) {
  const auto found = std::find_if(keys.begin(), keys.end(), [&](const KeySpec& key) { return key.path == path; });
  if (found == keys.end()) throw std::logic_error("no key " + path);
  return *found;
}

double read_number(const Value& map, const KeySpec& key) {
  if (!key.required && !map.has(key.name())) return key.value;
  return map.at(key.name()).as_number(key.lower, key.upper, key.unit);
}

int read_integer(const Value& map, const KeySpec& key) {
  if (!key.required && !map.has(key.name())) return static_cast<int>(key.value);
  return map.at(key.name()).as_integer(static_cast<int>(key.lower), static_cast<int>(key.upper));
}

bool read_boolean(const Value& map, const KeySpec& key) {
  if (!key.required && !map.has(key.name())) return key.value != 0.0;
  return map.at(key.name()).as_boolean();
}

std::string read_text(const Value& map, const KeySpec& key) {
  if (!key.required && !map.has(key.name())) return key.text;
  return map.at(key.name()).as_text();
}

std::string read_choice(const Value& map, const KeySpec& key) {
  if (!key.required && !map.has(key.name())) return key.choices.front();
  return map.at(key.name()).as_choice(key.choices);
}

}  // namespace tissue_stiffness
