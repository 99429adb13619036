#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// One key of a settings tree. The readers check values against it, and the documentation is generated from it.
struct KeySpec {
  enum class Kind { number, integer, boolean, text, choice, numbers, map, list };
  std::string path;  ///< below the root, e.g. "mesh.scale"; `*` stands for a user-defined name, `[]` for a list entry
  Kind kind = Kind::text;
  std::string unit;                  ///< SI unit of a number; "" for none
  double lower = 0.0, upper = 0.0;   ///< bounds of a number or an integer, inclusive
  std::vector<std::string> choices;  ///< allowed words of a choice; the first is the default
  bool required = false;
  double value = 0.0;   ///< default of a number or an integer, or of a boolean as 0 or 1; NaN: there is none
  std::string text;     ///< default of a text
  std::string meaning;  ///< explanation for the user, as a clause

  /// Returns the last part of the path, which is the key itself.
  std::string name() const;
};

// These functions make a key of each kind. It is required only where they say so. `value` is its default.
KeySpec plain_key(const std::string& path, KeySpec::Kind kind, const std::string& unit, const std::string& meaning);
KeySpec required_key(const std::string& path, KeySpec::Kind kind, const std::string& unit, const std::string& meaning);
KeySpec text_key(const std::string& path, const std::string& value, const std::string& meaning);
KeySpec number_key(const std::string& path, const std::string& unit, double lower, double upper, double value,
                   const std::string& meaning);
KeySpec required_number(const std::string& path, const std::string& unit, double lower, double upper,
                        const std::string& meaning);
KeySpec integer_key(const std::string& path, int lower, int upper, int value, const std::string& meaning);
KeySpec choice_key(const std::string& path, const std::vector<std::string>& choices, bool required,
                   const std::string& meaning);

/// Returns every key of a model file, in the order of the documentation. The effects' own keys are in their specs instead.
const std::vector<KeySpec>& model_keys();

/// Returns the key with this path. Throws std::logic_error when there is none.
const KeySpec& find_key(const std::vector<KeySpec>& keys, const std::string& path);

// These functions read the key from the map that holds it, or return its default. They throw InputError as Value's
// conversions do.
double read_number(const Value& map, const KeySpec& key);
int read_integer(const Value& map, const KeySpec& key);
bool read_boolean(const Value& map, const KeySpec& key);
std::string read_text(const Value& map, const KeySpec& key);
std::string read_choice(const Value& map, const KeySpec& key);

}  // namespace tissue_stiffness
