#pragma once

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>

namespace tissue_stiffness {

/// These return what Python gave as numbers: positions from (n, 3), indices from (n,), and the values of any shape row by
/// row. Throw InputError, naming `where`, for another shape or type, and for a number that is not finite.
Eigen::Matrix3Xd to_points(const pybind11::object& values, const std::string& where);
Eigen::VectorXi to_indices(const pybind11::object& values, const std::string& where);
Eigen::VectorXd to_numbers(const pybind11::object& values, const std::string& where);

/// Returns the columns of a matrix as rows, as NumPy's users expect points: (n, 3).
template <typename Scalar, int Rows>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> as_rows(
    const Eigen::Matrix<Scalar, Rows, Eigen::Dynamic>& columns) {
  return columns.transpose();
}

}  // namespace tissue_stiffness
