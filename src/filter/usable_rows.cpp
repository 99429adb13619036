#include "filter/usable_rows.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

UsableRows usable_rows(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs, const Noise& noise,
                       Eigen::Index points) {
  if (outputs.rows() != measurement.size() || noise.size() != measurement.size() || outputs.cols() != points) {
    throw std::invalid_argument("measurement, outputs and noise do not fit together");
  }
  const Eigen::Index rows = measurement.size();
  for (Eigen::Index point = 0; rows > 0 && point < points; ++point) {
    if (!outputs.col(point).array().isFinite().any()) {
      throw NumericalError("the model has no finite output at sigma point " + std::to_string(point));
    }
  }
  std::vector<Eigen::Index> indices;
  for (Eigen::Index row = 0; row < rows; ++row) {
    if (std::isfinite(measurement[row]) && outputs.row(row).allFinite() && noise.usable(row)) indices.push_back(row);
  }
  const auto count = static_cast<Eigen::Index>(indices.size());
  UsableRows usable{Eigen::VectorXd(count), Eigen::MatrixXd(count, points), noise.rows(indices), std::move(indices)};
  for (Eigen::Index i = 0; i < count; ++i) {
    const Eigen::Index row = usable.indices[static_cast<std::size_t>(i)];
    usable.measurement[i] = measurement[row];
    usable.outputs.row(i) = outputs.row(row);
  }
  return usable;
}

void UsableRows::report(const Eigen::VectorXd& innovation, const Eigen::VectorXd& variance, Eigen::Index rows,
                        FilterUpdate& update) const {
  update.dof = static_cast<int>(indices.size());
  update.innovation = Eigen::VectorXd::Constant(rows, std::numeric_limits<double>::quiet_NaN());
  update.innovation_sigma = update.innovation;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    update.innovation[indices[i]] = innovation[static_cast<Eigen::Index>(i)];
    update.innovation_sigma[indices[i]] = std::sqrt(variance[static_cast<Eigen::Index>(i)]);
  }
}

double log_density(double nis, double log_determinant, int dof) {
  constexpr double log_two_pi = 1.8378770664093453;
  return -0.5 * (nis + log_determinant + dof * log_two_pi);
}

}  // namespace tissue_stiffness
