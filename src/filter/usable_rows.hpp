#pragma once

#include <Eigen/Core>
#include <vector>

#include "filter/unscented_filter.hpp"

namespace tissue_stiffness {

/// The usable part of a measurement, with its positions among all rows.
struct UsableRows {
  Eigen::VectorXd measurement;
  Eigen::MatrixXd outputs;
  Noise noise;
  std::vector<Eigen::Index> indices;

  /// Fills in the innovation, its standard deviation and the row count of `update`. They are NaN in those of the `rows`
  /// that were not used.
  void report(const Eigen::VectorXd& innovation, const Eigen::VectorXd& variance, Eigen::Index rows,
              FilterUpdate& update) const;
};

/// Selects the usable rows. Throws std::invalid_argument for sizes that do not fit, NumericalError when an output has no
/// finite row.
UsableRows usable_rows(const Eigen::VectorXd& measurement, const Eigen::MatrixXd& outputs, const Noise& noise,
                       Eigen::Index points);

/// Returns the Gaussian log density of an innovation.
double log_density(double nis, double log_determinant, int dof);

}  // namespace tissue_stiffness
