#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tissue_stiffness {

struct TableRow {
  std::string where;  ///< FILE:LINE
  std::vector<double> numbers;
};

/// Returns the rows of a text file of numbers, which are separated by commas, semicolons or blanks. A first line that
/// begins with no number names the columns. Empty lines and lines that begin with # are left out. Throws InputError naming
/// file and line for a row that does not begin with `columns` finite numbers, as `what` describes them, and for a file
/// without rows.
std::vector<TableRow> read_table(const std::string& file, std::size_t columns, const std::string& what);

}  // namespace tissue_stiffness
