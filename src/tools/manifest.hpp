#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// One recording to estimate from, as a row of a manifest names it.
struct ManifestRow {
  std::vector<std::string> cells;          ///< of all columns
  std::string model_file, recording_file;  ///< their paths; the manifest's count from its folder
};

/// A table of recordings: a CSV file with a header that has the columns `model` and `recording`. Further columns go to the
/// merged table as they are.
struct Manifest {
  std::vector<std::string> columns;
  std::vector<ManifestRow> rows;
};

/// Reads a manifest. Cells may be in double quotes. Throws InputError, naming file and line, for a missing column, a row of
/// another length and a table without rows.
Manifest read_manifest(const std::string& file);

/// Returns the name of the folder for a row's results: that of the recording, and a hash (FNV-1a, 64 bits) of all that the
/// results depend on: model file, the files that it names, recording, versions, and the arguments of `estimate`.
std::string result_folder(const ManifestRow& row, const std::vector<std::string>& arguments);

/// Returns a row of a CSV file. Cells that hold a comma, a quote or a line break are quoted.
std::string csv_row(const std::vector<std::string>& cells);

}  // namespace tissue_stiffness
