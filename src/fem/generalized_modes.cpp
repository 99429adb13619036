#include "fem/generalized_modes.hpp"

#include <string>
#include <utility>
#include <vector>

#include "tissue_stiffness/types/error.hpp"

// LAPACK has no header of its own.
extern "C" void dsygvd_(const int* problem, const char* wanted, const char* triangle, const int* size, double* a,
                        const int* stride_of_a, double* b, const int* stride_of_b, double* values, double* work,
                        const int* work_size, int* integers, const int* integers_size, int* info);

namespace tissue_stiffness {

GeneralizedModes generalized_modes(Eigen::MatrixXd stiffness, Eigen::MatrixXd mass) {
  const int size = static_cast<int>(stiffness.rows()), problem = 1;
  GeneralizedModes out;
  out.values.resize(size);
  if (size == 0) return out;
  int info = 0;
  const auto solve = [&](double* work, int work_size, int* integers, int integers_size) {
    dsygvd_(&problem, "V", "L", &size, stiffness.data(), &size, mass.data(), &size, out.values.data(), work, &work_size,
            integers, &integers_size, &info);
  };
  double best_size = 0.0;
  int best_integers = 0;
  solve(&best_size, -1, &best_integers, -1);  // asks for the sizes of the workspace
  std::vector<double> work(static_cast<std::size_t>(best_size));
  std::vector<int> integers(static_cast<std::size_t>(best_integers));
  solve(work.data(), static_cast<int>(work.size()), integers.data(), best_integers);
  if (info != 0) {
    throw NumericalError("modes of " + std::to_string(size) + " vectors: " +
                         (info > size ? "the mass is not positive definite" : "the eigenvalues do not converge"));
  }
  out.vectors = std::move(stiffness);
  return out;
}

}  // namespace tissue_stiffness
