#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "tissue_stiffness/settings/model_settings.hpp"

namespace XmlRpc {
class XmlRpcValue;
}

namespace tissue_stiffness {

/// Converts a parameter of the ROS parameter server to a settings tree. Text that is a number becomes one, because
/// rosparam's YAML reader takes 30e3 for text.
Value to_value(const XmlRpc::XmlRpcValue& parameter, const std::string& path);

/// Settings of a node: a model, and the node's own keys.
struct NodeSettings {
  Value model;            ///< the model file, or the private parameters without the node's own
  std::string directory;  ///< folder from which the model's relative paths are resolved
  Value own;              ///< map of the node's own parameters
};

/// Reads the node's private parameters. The model is the file that `~model` names. Without `~model` it is the private
/// parameters themselves, and relative paths count from `~directory` (default: the working directory). `own_keys` are the
/// node's other parameters. Throws InputError when both `~model` and keys of a model are there, and when the model names a
/// file outside its folder without `~allow_outside`.
NodeSettings read_node_settings(const ros::NodeHandle& private_node, const std::vector<std::string>& own_keys);

}  // namespace tissue_stiffness
