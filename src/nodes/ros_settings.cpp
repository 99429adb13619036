#include "nodes/ros_settings.hpp"

#include <XmlRpcValue.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <utility>

#include "settings/inside_folder.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using XmlRpc::XmlRpcValue;
using Entries = std::vector<std::pair<std::string, Value>>;

Value text_or_number(const std::string& text, const std::string& path) {
  const bool may_be = !text.empty() && text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  char* end = nullptr;
  const double number = may_be ? std::strtod(text.c_str(), &end) : 0.0;
  return may_be && *end == '\0' ? Value::number(number, path) : Value::text(text, path);
}

Value list_value(XmlRpcValue& parameter, const std::string& path) {
  std::vector<Value> items;
  for (int i = 0; i < parameter.size(); ++i) items.push_back(to_value(parameter[i], path + "[" + std::to_string(i) + "]"));
  return Value::list(std::move(items), path);
}

Value map_value(XmlRpcValue& parameter, const std::string& path) {
  Entries entries;
  for (auto& [key, value] : parameter) entries.emplace_back(key, to_value(value, path + "." + key));
  return Value::map(std::move(entries), path);
}

bool contains(const std::vector<std::string>& keys, const std::string& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

}  // namespace

Value to_value(const XmlRpcValue& parameter, const std::string& path) {
  XmlRpcValue copy = parameter;  // XmlRpcValue has no const access on older ROS
  switch (copy.getType()) {
    case XmlRpcValue::TypeBoolean:
      return Value::boolean(static_cast<bool>(copy), path);
    case XmlRpcValue::TypeInt:
      return Value::number(static_cast<int>(copy), path);
    case XmlRpcValue::TypeDouble:
      return Value::number(static_cast<double>(copy), path);
    case XmlRpcValue::TypeString:
      return text_or_number(static_cast<std::string&>(copy), path);
    case XmlRpcValue::TypeArray:
      return list_value(copy, path);
    case XmlRpcValue::TypeStruct:
      return map_value(copy, path);
    case XmlRpcValue::TypeInvalid:
      return Value::null(path);
    default:
      throw InputError(path, "a binary value or a date", "numbers, text, booleans, lists and maps");
  }
}

NodeSettings read_node_settings(const ros::NodeHandle& private_node, const std::vector<std::string>& own_keys) {
  const std::string where = "parameters of " + private_node.getNamespace();
  XmlRpcValue parameters;
  Entries model, own;
  bool allow_outside = false;
  std::string file, directory = std::filesystem::current_path().string();
  if (private_node.getParam("", parameters) && parameters.getType() == XmlRpcValue::TypeStruct) {
    for (auto& [key, parameter] : parameters) {
      Value value = to_value(parameter, where + ": " + key);
      if (key == "model") {
        file = value.as_text();
      } else if (key == "directory") {
        directory = value.as_text();
      } else if (key == "allow_outside") {
        allow_outside = value.as_boolean();
      } else if (contains(own_keys, key)) {
        own.emplace_back(key, std::move(value));
      } else {
        model.emplace_back(key, std::move(value));
      }
    }
  }
  Value own_map = Value::map(std::move(own), where);
  const std::string or_else = ", or the parameter allow_outside";
  if (file.empty()) {
    const Value given = Value::map(std::move(model), where);
    if (!allow_outside) require_files_inside(given, directory, or_else);
    return {given, directory, std::move(own_map)};
  }
  if (!model.empty()) {
    throw InputError(model.front().second.path(), model.front().second.shown(),
                     "either `model` (here " + file + ") or the model's keys, not both");
  }
  if (!allow_outside) require_files_inside(file, or_else);
  return {load_yaml(file), std::filesystem::absolute(file).parent_path().string(), std::move(own_map)};
}

}  // namespace tissue_stiffness
