#include "tools/merge_manifest.hpp"

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "tools/read_text.hpp"

namespace tissue_stiffness {
namespace {

namespace fs = std::filesystem;

using Cells = std::vector<std::pair<std::string, std::string>>;  // column and content

std::string shown(const nlohmann::json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Wall times are left out: they differ from run to run.
Cells cells_of(const fs::path& folder) {
  Cells out;
  const nlohmann::json status = read_json(folder / "status.json");
  if (!status.is_object()) return out;
  for (const char* key : {"exit_code", "message"}) out.emplace_back(key, shown(status.value(key, nlohmann::json())));
  const nlohmann::json results = read_json(folder / "results.json");
  if (!results.is_object() || !results.value("complete", false)) return out;
  for (const char* key : {"state", "state_reason", "frames", "rms_error", "relative_error"}) {
    out.emplace_back(key, shown(results.value(key, nlohmann::json())));
  }
  const nlohmann::json none = nlohmann::json::object();
  const nlohmann::json& parameters = results.contains("parameters") ? results.at("parameters") : none;
  for (const auto& [name, parameter] : parameters.items()) {
    const std::string unit = " [" + parameter.value("unit", std::string()) + "]";
    out.emplace_back(name + unit, shown(parameter.value("mean", nlohmann::json())));
    out.emplace_back(name + " std" + unit, shown(parameter.value("std", nlohmann::json())));
    const nlohmann::json interval = parameter.value("interval95", nlohmann::json());
    if (!interval.is_array() || interval.size() != 2) continue;
    out.emplace_back(name + " lower95" + unit, shown(interval[0]));
    out.emplace_back(name + " upper95" + unit, shown(interval[1]));
  }
  return out;
}

}  // namespace

std::string merge_manifest(const Manifest& manifest, const std::string& output, const std::vector<std::string>& arguments) {
  std::vector<Cells> found;
  std::vector<std::string> columns{"exit_code", "message",   "state",         "state_reason",
                                   "frames",    "rms_error", "relative_error"};
  for (const ManifestRow& row : manifest.rows) {
    found.push_back(cells_of(fs::path(output) / result_folder(row, arguments)));
    for (const auto& [column, content] : found.back()) {
      if (std::find(columns.begin(), columns.end(), column) == columns.end()) columns.push_back(column);
    }
  }
  std::vector<std::string> header = manifest.columns;
  header.insert(header.end(), columns.begin(), columns.end());
  std::string table = csv_row(header);
  for (std::size_t i = 0; i < found.size(); ++i) {
    std::vector<std::string> cells = manifest.rows[i].cells;
    for (const std::string& column : columns) {
      const auto at =
          std::find_if(found[i].begin(), found[i].end(), [&](const auto& cell) { return cell.first == column; });
      cells.push_back(at == found[i].end() ? "" : at->second);
    }
    table += csv_row(cells);
  }
  return table;
}

}  // namespace tissue_stiffness
