#include "tools/print_keys.hpp"

#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "nodes/node_keys.hpp"
#include "settings/key_spec.hpp"
#include "tools/camera_file.hpp"
#include "tools/scene_keys.hpp"

namespace tissue_stiffness {
namespace {

using Kind = KeySpec::Kind;

std::string shown(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string range(const KeySpec& key) {
  const bool above_zero = key.lower == std::numeric_limits<double>::min();
  const bool any_low = std::isinf(key.lower);
  const bool any_high = std::isinf(key.upper) || key.upper == std::numeric_limits<int>::max();
  if (any_low && any_high) return "any number";
  if (any_high) return (above_zero ? "> 0" : ">= " + shown(key.lower));
  return (above_zero ? "> 0, up to " : shown(key.lower) + " to ") + shown(key.upper);
}

std::string allowed(const KeySpec& key) {
  std::string choices;
  switch (key.kind) {
    case Kind::number:
    case Kind::integer:
      return range(key);
    case Kind::boolean:
      return "true, false";
    case Kind::text:
      return "text";
    case Kind::numbers:
      return "a list of numbers";
    case Kind::map:
      return "a map";
    case Kind::list:
      return "a list";
    case Kind::choice:
      for (const std::string& choice : key.choices) choices += (choices.empty() ? "" : ", ") + choice;
      return choices;
  }
  return "";
}

std::string fallback(const KeySpec& key) {
  if (key.required) return "required";
  if (key.kind == Kind::number || key.kind == Kind::integer) return std::isnan(key.value) ? "-" : shown(key.value);
  if (key.kind == Kind::boolean) return key.value != 0.0 ? "true" : "false";
  if (key.kind == Kind::choice) return key.choices.front();
  return key.text.empty() ? "-" : key.text;
}

void print_table(const std::vector<KeySpec>& keys, std::ostream& out) {
  out << "| key | unit | allowed | default | meaning |\n|---|---|---|---|---|\n";
  for (const KeySpec& key : keys) {
    out << "| `" << key.path << "` | " << (key.unit.empty() ? "-" : key.unit) << " | " << allowed(key) << " | "
        << fallback(key) << " | " << key.meaning << " |\n";
  }
}

void print_lines(const std::vector<KeySpec>& keys, std::ostream& out) {
  for (const KeySpec& key : keys) {
    out << "  " << key.path << (key.unit.empty() ? "" : " [" + key.unit + "]") << ": " << key.meaning << " ("
        << allowed(key) << "; " << (key.required ? "required" : "default " + fallback(key)) << ")\n";
  }
}

}  // namespace

void print_keys(std::ostream& out) {
  out << "model file\n";
  print_lines(model_keys(), out);
  out << "\nscene file, beside the model's keys\n";
  print_lines(scene_keys(), out);
  out << "\ncamera file, for --camera\n";
  print_lines(camera_keys(), out);
  out << "\nevery node but fault_injector\n";
  print_lines(common_node_keys(), out);
  for (const std::string& node : node_names()) {
    out << "\n" << node << "\n";
    print_lines(node_keys(node), out);
  }
}

void print_keys_markdown(std::ostream& out) {
  out << "# Parameters\n\n`parameters --markdown` writes this page from what the readers check against. A key that is "
         "not here is an error, and the\nmessage says which were meant. All units are SI. [effects.md](effects.md) has the "
         "keys of each effect.\n\n"
         "## The model file\n\n`*` stands for a name of your own, `[]` for an entry of a list. A key is required where the "
         "map "
         "that holds it is there.\n\n";
  print_table(model_keys(), out);
  out << "\n## A scene file, for `simulate`\n\nA scene file is a model file whose numbers are all known. It also says how "
         "the model is run and recorded. `sensors` takes\nthe keys of a cloud, of a pinhole camera or of a B-mode "
         "slice.\n\n";
  print_table(scene_keys(), out);
  out << "\n## A camera file, for `--camera`\n\nA camera file is what `camera_calibration` writes, with the sensor's pose "
         "added. It belongs to a film, for `pack`, `estimate` and `diagnose`.\n\n";
  print_table(camera_keys(), out);
  out << "\n## Private parameters of the nodes\n\nEvery node but `fault_injector` takes these keys:\n\n";
  print_table(common_node_keys(), out);
  for (const std::string& node : node_names()) {
    out << "\n### `" << node << "`\n\n";
    print_table(node_keys(node), out);
  }
}

}  // namespace tissue_stiffness
