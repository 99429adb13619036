#pragma once

#include <string>

namespace tissue_stiffness {

/// A model file for a page: what the page calls it, and its content.
struct NamedModel {
  std::string name, text;
};

/// Returns the table of the entries in which two model files differ, or a sentence that they say the same. Throws
/// InputError, naming the model and the line, for a text that is no YAML.
std::string difference_table(const NamedModel& before, const NamedModel& after);

}  // namespace tissue_stiffness
