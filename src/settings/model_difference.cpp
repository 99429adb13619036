#include "settings/model_difference.hpp"

#include <algorithm>
#include <filesystem>
#include <map>

#include "tissue_stiffness/settings/value.hpp"

namespace tissue_stiffness {
namespace {

using Entries = std::vector<std::pair<std::string, const Value*>>;

/// Returns the value as YAML in one line.
std::string written(const Value& value) {
  std::string text;
  const auto add = [&text](const std::string& item) { text += (text.empty() ? "" : ", ") + item; };
  switch (value.type()) {
    case Value::Type::null:
      return "~";
    case Value::Type::text:
      return value.as_text();
    case Value::Type::list:
      for (const Value& item : value.items()) add(written(item));
      return "[" + text + "]";
    case Value::Type::map:
      for (const std::string& key : value.keys()) add(key + ": " + written(value.at(key)));
      return "{" + text + "}";
    default:
      return value.shown();
  }
}

bool names_things(const Value& list) {
  const std::vector<Value>& items = list.items();
  return !items.empty() && std::all_of(items.begin(), items.end(), [](const Value& item) {
    return item.type() == Value::Type::map && item.keys().size() == 1;
  });
}

/// Returns the entries of a map, or of a list of things with a name each; nothing for other values.
Entries entries(const Value& value) {
  Entries out;
  if (value.type() == Value::Type::map) {
    for (const std::string& key : value.keys()) out.emplace_back(key, &value.at(key));
  }
  if (value.type() != Value::Type::list || !names_things(value)) return out;
  std::map<std::string, int> count;
  for (const Value& item : value.items()) {
    const std::string name = item.keys().front();
    const int number = ++count[name];
    out.emplace_back(number == 1 ? name : name + "#" + std::to_string(number), &item.at(name));
  }
  return out;
}

const Value* find(const Entries& all, const std::string& name) {
  const auto at = std::find_if(all.begin(), all.end(), [&](const auto& entry) { return entry.first == name; });
  return at == all.end() ? nullptr : at->second;
}

bool same_file(const Value& a, const Value& b) {
  if (a.type() != Value::Type::text || b.type() != Value::Type::text) return false;
  return std::filesystem::path(a.as_text()).filename() == std::filesystem::path(b.as_text()).filename();
}

class Comparer {
 public:
  void compare(const Value& before, const Value& after, const std::string& path) {
    const Entries old = entries(before), now = entries(after);
    if (old.empty() || now.empty()) {
      if (!before.same(after)) out.push_back({path, written(before), written(after)});
      return;
    }
    for (const auto& [name, value] : old) {
      const Value* other = find(now, name);
      if (other == nullptr) {
        out.push_back({below(path, name), written(*value), ""});
      } else if (name != "file" || !same_file(*value, *other)) {
        compare(*value, *other, below(path, name));
      }
    }
    for (const auto& [name, value] : now) {
      if (find(old, name) == nullptr) out.push_back({below(path, name), "", written(*value)});
    }
  }

  std::vector<EntryDifference> out;

 private:
  /// The parameters of an effect have no name before the effect's.
  static std::string below(const std::string& path, const std::string& name) {
    return path.empty() || path == "effects" ? name : path + "." + name;
  }
};

}  // namespace

std::vector<EntryDifference> model_difference(const std::string& before, const std::string& after,
                                              const std::pair<std::string, std::string>& names) {
  Comparer comparer;
  comparer.compare(parse_yaml(before, names.first), parse_yaml(after, names.second), "");
  return comparer.out;
}

}  // namespace tissue_stiffness
