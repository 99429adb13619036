#pragma once

#include <string>
#include <vector>

namespace tissue_stiffness {

/// Splits CSV text into rows of cells (RFC 4180). Empty lines are left out.
std::vector<std::vector<std::string>> split_csv(const std::string& text);

/// Returns a text as a cell of CSV: quoted where needed, with its quotes doubled (RFC 4180).
std::string csv_field(const std::string& text);

}  // namespace tissue_stiffness
