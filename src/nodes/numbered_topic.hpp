#pragma once

#include <string>

namespace tissue_stiffness {

/// Returns the topic of the first, second, ... sensor of a kind: NAME, NAME_2, NAME_3, ...
inline std::string numbered_topic(const std::string& name, std::size_t number) {
  return number == 1 ? name : name + "_" + std::to_string(number);
}

}  // namespace tissue_stiffness
