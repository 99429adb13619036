#include "python/arrays.hpp"

#include <cstdint>
#include <limits>

#include "tissue_stiffness/types/error.hpp"

namespace py = pybind11;

namespace tissue_stiffness {
namespace {

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape"));
}

/// Returns the values as an array whose type is one of `kinds` of NumPy's.
py::array to_array(const py::object& values, const std::string& kinds, const std::string& where,
                   const std::string& allowed) {
  py::array array = py::array::ensure(values);
  if (!array) throw InputError(where, py::str(values.get_type()), allowed);
  if (array.size() > 0 && kinds.find(array.dtype().kind()) == std::string::npos) {
    throw InputError(where, "dtype " + std::string(py::str(array.dtype())), allowed);
  }
  return array;
}

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Returns the values row by row, in a copy that nobody else changes.
Eigen::VectorXd flat(const py::array& array) {
  const Numbers numbers(array);
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), numbers.size());
}

}  // namespace

Eigen::Matrix3Xd to_points(const py::object& values, const std::string& where) {
  const py::array array = to_array(values, "fiu", where, "an array of numbers of shape (n, 3) [m]");
  if (array.ndim() != 2 || array.shape(1) != 3) throw InputError(where, "shape " + shape_of(array), "shape (n, 3) [m]");
  const Eigen::VectorXd numbers = flat(array);
  Eigen::Matrix3Xd points = Eigen::Map<const Eigen::Matrix3Xd>(numbers.data(), 3, numbers.size() / 3);
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (points.col(i).allFinite()) continue;
    throw InputError(where, "a number that is not finite in row " + std::to_string(i),
                     "finite numbers; leave out the rows that were not measured");
  }
  return points;
}

Eigen::VectorXi to_indices(const py::object& values, const std::string& where) {
  const py::array array = to_array(values, "iu", where, "an array of integers of shape (n,)");
  if (array.ndim() != 1) throw InputError(where, "shape " + shape_of(array), "shape (n,)");
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> wide(array);
  Eigen::VectorXi indices(array.size());
  for (Eigen::Index i = 0; i < indices.size(); ++i) {
    const std::int64_t index = wide.data()[i];
    if (index < 0 || index > std::numeric_limits<int>::max()) {
      throw InputError(where, std::to_string(index) + " in row " + std::to_string(i), "indices from 0");
    }
    indices[i] = static_cast<int>(index);
  }
  return indices;
}

Eigen::VectorXd to_numbers(const py::object& values, const std::string& where) {
  Eigen::VectorXd numbers = flat(to_array(values, "fiu", where, "numbers"));
  if (!numbers.allFinite()) throw InputError(where, "a number that is not finite", "finite numbers");
  return numbers;
}

}  // namespace tissue_stiffness
