#include <algorithm>
#include <cstdint>
#include <cstring>
#include <limits>
#include <utility>
#include <vector>

#include "meshing/file_cursor.hpp"
#include "meshing/vtk_grid.hpp"
#include "tissue_stiffness/meshing/mesh_io.hpp"

namespace tissue_stiffness {
namespace {

constexpr long long kMaxCount = std::numeric_limits<int>::max() / 32;

class VtkReader {
 public:
  explicit VtkReader(const std::string& file) : in_(file) {}

  VtkGrid read() {
    const std::string magic = in_.line();
    if (magic.rfind("# vtk DataFile", 0) != 0) in_.fail("another first line", "'# vtk DataFile Version ...' (legacy VTK)");
    in_.line();  // title
    const std::string format = in_.word();
    if (format != "ASCII" && format != "BINARY") in_.fail("'" + format + "'", "ASCII or BINARY");
    binary_ = format == "BINARY";
    expect("DATASET", "UNSTRUCTURED_GRID");
    VtkGrid grid;
    while (!in_.at_end() && grid.types.empty()) read_section(grid);
    if (grid.types.empty()) in_.fail("the end of the file", "POINTS, CELLS and CELL_TYPES");
    if (grid.types.size() + 1 != grid.offsets.size()) in_.fail("another count of cell types", "one a cell");
    return grid;
  }

  [[noreturn]] void fail(const std::string& found, const std::string& allowed) { in_.fail(found, allowed); }

 private:
  void expect(const std::string& key, const std::string& value) {
    const std::string found_key = in_.word(), found = in_.word();
    if (found_key != key || found != value) in_.fail("'" + found_key + " " + found + "'", key + " " + value);
  }

  void read_section(VtkGrid& grid) {
    const std::string key = in_.word();
    if (key == "POINTS") {
      const long long count = in_.integer("point count", 0, kMaxCount);
      const std::vector<double> values = read_array<double>(in_.word(), 3 * count, "points");
      grid.points.resize(3, count);
      std::copy(values.begin(), values.end(), grid.points.data());
    } else if (key == "CELLS") {
      read_cells(grid);
    } else if (key == "CELL_TYPES") {
      const std::vector<long long> types =
          read_array<long long>("int", in_.integer("cell count", 0, kMaxCount), "cell types");
      if (types.empty()) in_.fail("no cells", "tetrahedra");
      for (const long long type : types) grid.types.push_back(static_cast<int>(type));
    } else if (key == "METADATA") {
      in_.line();
      while (!in_.line().empty()) continue;  // ends with an empty line
    } else {
      in_.fail("section '" + key + "'", "POINTS, CELLS, CELL_TYPES or METADATA before any data");
    }
  }

  void read_cells(VtkGrid& grid) {
    const long long first = in_.integer("cell count", 0, kMaxCount);
    const long long second = in_.integer("size of the cell list", 0, kMaxCount);
    if (in_.peek() == "OFFSETS") {  // version 5.1: `first` offsets and `second` nodes
      in_.word();
      grid.offsets = read_array<long long>(in_.word(), first, "cell offsets");
      if (in_.word() != "CONNECTIVITY") in_.fail("another section", "CONNECTIVITY behind OFFSETS");
      grid.nodes = read_array<long long>(in_.word(), second, "cell nodes");
      if (!std::is_sorted(grid.offsets.begin(), grid.offsets.end()) || grid.offsets.empty() || grid.offsets.front() != 0 ||
          grid.offsets.back() != second) {
        in_.fail("cell offsets that do not run from 0 to the " + std::to_string(second) + " cell nodes", "growing offsets");
      }
    } else {
      const std::vector<long long> list = read_array<long long>("int", second, "cells");
      grid.offsets.push_back(0);
      for (std::size_t i = 0; i < list.size();) {
        const long long count = list[i++];
        if (count < 0 || count > static_cast<long long>(list.size() - i)) in_.fail("a cell longer than the list", "less");
        const auto begin = list.begin() + static_cast<std::ptrdiff_t>(i);
        grid.nodes.insert(grid.nodes.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
        grid.offsets.push_back(static_cast<long long>(grid.nodes.size()));
        i += static_cast<std::size_t>(count);
      }
      if (static_cast<long long>(grid.offsets.size()) != first + 1)
        in_.fail("another count of cells", std::to_string(first));
    }
  }

  template <typename To>
  std::vector<To> read_array(const std::string& type, long long count, const std::string& what) {
    in_.require(count, 2, what);  // a digit and a separator, or more in binary
    std::vector<To> values(static_cast<std::size_t>(count));
    if (!binary_) {
      for (To& value : values) {
        if constexpr (std::is_floating_point_v<To>) {
          value = in_.number(what);
        } else {
          value = in_.integer(what, 0, std::numeric_limits<long long>::max());
        }
      }
      return values;
    }
    in_.line();  // binary data start on the next line
    if (type == "double")
      convert<double>(values, what);
    else if (type == "float")
      convert<float>(values, what);
    else if (type == "int" || type == "vtktypeint32")
      convert<std::int32_t>(values, what);
    else if (type == "long" || type == "vtktypeint64" || type == "vtkIdType")
      convert<std::int64_t>(values, what);
    else
      in_.fail("type '" + type + "' of " + what, "double, float, int, vtktypeint32, vtktypeint64 or vtkIdType");
    return values;
  }

  template <typename From, typename To>
  void convert(std::vector<To>& values, const std::string& what) {
    const char* bytes = in_.binary(values.size() * sizeof(From), what);
    for (std::size_t i = 0; i < values.size(); ++i) {
      char swapped[sizeof(From)];  // legacy VTK is big-endian
      std::reverse_copy(bytes + i * sizeof(From), bytes + (i + 1) * sizeof(From), swapped);
      From value;
      std::memcpy(&value, swapped, sizeof(From));
      values[i] = static_cast<To>(value);
    }
  }

  FileCursor in_;
  bool binary_ = false;
};

}  // namespace

TetFile read_vtk(const std::string& file) {
  VtkReader reader(file);
  VtkGrid grid = reader.read();
  return tets_of_grid(std::move(grid),
                      [&](const std::string& found, const std::string& allowed) { reader.fail(found, allowed); });
}

}  // namespace tissue_stiffness
