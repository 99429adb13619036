#pragma once

#include <string>
#include <vector>

#include "tools/pack_recording.hpp"

namespace tissue_stiffness {

class CommandLine;

/// The files of a recording that was made without ROS, on a command line.
struct DataOption {
  std::vector<std::string> data, films, cameras;
  double scale = 1.0;

  /// Adds --data, --video, --camera and --scale. `intent` precedes what they mean.
  void add_to(CommandLine& line, const std::string& intent);
  bool empty() const { return data.empty() && films.empty() && cameras.empty(); }
  /// Throws InputError unless there is either a recording (empty: none) or a file of these options.
  void check_beside(const std::string& recording) const;
  /// Packs the files into `recording.bag` in that folder, and returns its name.
  std::string pack(const ModelSettings& settings, const std::string& folder) const;
  /// Throws InputError for a text without TOPIC=FILE, for no file at all, and for films without their cameras.
  PackedFiles files() const;
};

}  // namespace tissue_stiffness
