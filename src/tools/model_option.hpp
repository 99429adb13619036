#pragma once

#include <string>

#include "settings/inside_folder.hpp"
#include "tissue_stiffness/settings/model_settings.hpp"
#include "tools/command_line.hpp"

namespace tissue_stiffness {

/// A tool's argument for its model file or scene, and the flag that lets this file name others outside its folder.
struct ModelOption {
  std::string file;
  bool allow_outside = false;

  /// Adds both, and returns the argument of the file.
  CommandArgument& add_to(CommandLine& line, const std::string& name = "MODEL",
                          const std::string& what = "model file (YAML)") {
    add_flag_to(line);
    return line.add_positional(name, file, what).required();
  }
  void add_flag_to(CommandLine& line) {
    line.add_flag("--allow-outside", allow_outside, "let the model name files outside its own folder");
  }

  /// Throws InputError for a file outside the model's folder, unless that is allowed.
  void check() const {
    if (!allow_outside) require_files_inside(file, ", or --allow-outside");
  }
  /// Checks and loads a model file.
  ModelSettings load() const {
    check();
    return load_model(file);
  }
};

}  // namespace tissue_stiffness
