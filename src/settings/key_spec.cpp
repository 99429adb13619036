#include "settings/key_spec.hpp"

#include <algorithm>
#include <stdexcept>

namespace tissue_stiffness {

std::string KeySpec::name() const {
  return path.substr(path.rfind('.') + 1);
}

KeySpec plain_key(const std::string& path, KeySpec::Kind kind, const std::string& unit, const std::string& meaning) {
  return {path, kind, unit, 0, 0, {}, false, 0, "", meaning};
}

KeySpec required_key(const std::string& path, KeySpec::Kind kind, const std::string& unit, const std::string& meaning) {
  return {path, kind, unit, 0, 0, {}, true, 0, "", meaning};
}

KeySpec text_key(const std::string& path, const std::string& value, const std::string& meaning) {
  return {path, KeySpec::Kind::text, "", 0, 0, {}, false, 0, value, meaning};
}

KeySpec number_key(const std::string& path, const std::string& unit, double lower, double upper, double value,
                   const std::string& meaning) {
  return {path, KeySpec::Kind::number, unit, lower, upper, {}, false, value, "", meaning};
}

KeySpec required_number(const std::string& path, const std::string& unit, double lower, double upper,
                        const std::string& meaning) {
  return {path, KeySpec::Kind::number, unit, lower, upper, {}, true, 0, "", meaning};
}

KeySpec integer_key(const std::string& path, int lower, int upper, int value, const std::string& meaning) {
  return {path, KeySpec::Kind::integer, "", double(lower), double(upper), {}, false, double(value), "", meaning};
}

KeySpec choice_key(const std::string& path, const std::vector<std::string>& choices, bool required,
                   const std::string& meaning) {
  return {path, KeySpec::Kind::choice, "", 0, 0, choices, required, 0, "", meaning};
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
