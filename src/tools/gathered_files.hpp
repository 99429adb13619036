#pragma once

#include <map>
#include <string>
#include <utility>

namespace tissue_stiffness {

/// Copies the files that a model names into `model_files` of a folder, so that a model written there finds them wherever
/// the folder goes. What lies in the folder stays where it is.
class GatheredFiles {
 public:
  explicit GatheredFiles(std::string folder) : folder_(std::move(folder)) {}

  /// Returns what the model shall call the file at an absolute path. The `.ele` of a `.node` comes along. Throws InputError
  /// for a file that cannot be copied.
  std::string operator()(const std::string& path);

 private:
  std::string folder_;
  std::map<std::string, std::string> paths_;  ///< by name in `model_files`
};

}  // namespace tissue_stiffness
