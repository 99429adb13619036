#include "report/read_results.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

using nlohmann::json;

constexpr std::uintmax_t kLargestFile = 100'000'000;
const char* const kAllowed = "the results.json of a finished `estimate`";

/// One value of the file, which knows where it is.
class Entry {
 public:
  Entry(const json& value, std::string where) : value_(value), where_(std::move(where)) {}

  bool has(const std::string& key) const { return value_.is_object() && value_.contains(key); }
  Entry at(const std::string& key) const {
    if (!has(key)) throw InputError(where_ + ": " + key, "nothing", kAllowed);
    return {value_.at(key), where_ + ": " + key};
  }
  const json& value() const { return value_; }
  template <typename T>
  T as() const {
    try {
      return value_.get<T>();
    } catch (const json::exception&) {
      const bool nested = value_.is_structured();
      throw InputError(where_, nested ? "a list or a map" : value_.dump(-1, ' ', false, json::error_handler_t::replace),
                       kAllowed);
    }
  }

 private:
  const json& value_;
  std::string where_;
};

void read_map(const Entry& map, SavedResults& out) {
  const Entry patches = map.at("patches");
  for (const json& item : patches.value()) {
    const Entry patch(item, out.file + ": map: patches");
    out.patches.push_back({patch.at("young_modulus").as<double>(), patch.at("identified").as<bool>()});
  }
  out.map_misfit = map.at("misfit").as<double>();
}

}  // namespace

SavedResults read_results(const std::string& path) {
  SavedResults out;
  out.file = std::filesystem::is_directory(path) ? (std::filesystem::path(path) / "results.json").string() : path;
  const json root = json::parse(read_file(out.file, out.file, kAllowed, kLargestFile), nullptr, false);
  if (!root.is_object()) throw InputError(out.file, "no JSON object", kAllowed);
  const Entry all(root, out.file);
  if (all.has("recordings"))
    throw InputError(out.file + ": recordings", "several recordings", "the results of one recording");
  out.model = all.at("model").as<std::string>();
  out.recording = all.at("recording").as<std::string>();
  out.model_text = all.at("model_text").as<std::string>();
  if (out.model_text.empty()) throw InputError(out.file + ": model_text", "nothing", kAllowed);
  out.nodes = all.at("mesh").at("nodes").as<int>();
  out.tetrahedra = all.at("mesh").at("tetrahedra").as<int>();
  for (const auto& item : all.at("parameters").value().items()) {
    const Entry parameter(item.value(), out.file + ": parameters: " + item.key());
    out.parameters[item.key()] = parameter.at("mean").as<double>();
  }
  out.state = all.at("state").as<std::string>();
  out.state_reason = all.at("state_reason").as<std::string>();
  out.complete = all.at("complete").as<bool>();
  if (all.has("map")) read_map(all.at("map"), out);
  return out;
}

}  // namespace tissue_stiffness
