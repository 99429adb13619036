#pragma once

#include <string>
#include <utility>
#include <vector>

#include "settings/key_spec.hpp"

namespace tissue_stiffness {

/// Returns the private parameters of every node that has a model: `model` and `directory`.
const std::vector<KeySpec>& common_node_keys();

/// Returns a node's own private parameters. Throws std::logic_error for an unknown node.
const std::vector<KeySpec>& node_keys(const std::string& node);

/// Returns the nodes that have any, in the order of the data flow.
const std::vector<std::string>& node_names();

/// Returns the names of the keys.
std::vector<std::string> names_of(const std::vector<KeySpec>& keys);

}  // namespace tissue_stiffness
