#pragma once

#include <string>
#include <vector>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {

/// One key of a settings tree: what the readers check it against and the documentation is written from.
struct KeySpec {
  enum class Kind { number, integer, boolean, text, choice, numbers, map, list };
  std::string path;  ///< below the root, "mesh.scale"; `*` stands for a name of the user's, `[]` for an entry of a list
  Kind kind = Kind::text;
  std::string unit;                  ///< of numbers, SI; "" for none
  double lower = 0.0, upper = 0.0;   ///< of a number or an integer, both allowed
  std::vector<std::string> choices;  ///< of a choice; the first is the default
  bool required = false;
  double value = 0.0;   ///< of a number or an integer that is not given, of a boolean 0 or 1; NaN: none
  std::string text;     ///< of a text that is not given
  std::string meaning;  ///< for people, as a clause

  /// Last part of the path, the key itself.
  std::string name() const;
};

// A key of each kind, not required unless it says so. `value`: what it is when it is not given.
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

/// Every key of a model file but the effects' own, which their specs hold. In the order in which they are documented.
const std::vector<KeySpec>& model_keys();

/// The one of that path. Throws std::logic_error when there is none.
const KeySpec& find_key(const std::vector<KeySpec>& keys, const std::string& path);

// Reads the key from the map that holds it, or gives its default. Throws InputError as Value's conversions do.
double read_number(const Value& map, const KeySpec& key);
int read_integer(const Value& map, const KeySpec& key);
bool read_boolean(const Value& map, const KeySpec& key);
std::string read_text(const Value& map, const KeySpec& key);
std::string read_choice(const Value& map, const KeySpec& key);

}  // namespace tissue_stiffness
