#include "types/read_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tissue_stiffness/types/error.hpp"
#include "types/read_file.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::uintmax_t kLargestFile = 500000000;  // [byte]

std::vector<double> numbers_of(std::string line) {
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
  std::istringstream stream(line);
  std::vector<double> numbers;
  for (double number = 0.0; stream >> number && std::isfinite(number);) numbers.push_back(number);
  return numbers;
}

}  // namespace

std::vector<TableRow> read_table(const std::string& file, std::size_t columns, const std::string& what) {
  std::istringstream stream(read_file(file, file, "a CSV file with rows of " + what, kLargestFile));
  std::vector<TableRow> rows;
  std::string line;
  for (int number = 1; std::getline(stream, line); ++number) {
    if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
    TableRow row{file + ":" + std::to_string(number), numbers_of(line)};
    if (row.numbers.empty() && number == 1) continue;
    if (row.numbers.size() < columns) throw InputError(row.where, "'" + line + "'", what);
    rows.push_back(std::move(row));
  }
  if (rows.empty()) throw InputError(file, "no rows", "at least one row of " + what);
  return rows;
}

}  // namespace tissue_stiffness
