#pragma once

#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/settings/key_spec.hpp"

namespace tissue_stiffness {

/// The private parameters that every node has: `model` and `directory`.
const std::vector<KeySpec>& common_node_keys();

/// A node's own private parameters. Throws std::logic_error for an unknown node.
const std::vector<KeySpec>& node_keys(const std::string& node);

/// The nodes that have any, in the order in which data flow.
const std::vector<std::string>& node_names();

/// Names of the keys.
std::vector<std::string> names_of(const std::vector<KeySpec>& keys);

}  // namespace tissue_stiffness
