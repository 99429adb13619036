#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

namespace tissue_stiffness {

/// Returns the text of a file that a tool has already read once; empty where there is none.
std::string read_text(const std::string& file);

/// Returns what a file of JSON holds; a discarded value where there is none, or where it is no JSON.
nlohmann::json read_json(const std::filesystem::path& file);

}  // namespace tissue_stiffness
