#pragma once

#include <Eigen/Core>
#include <map>

namespace tissue_stiffness {

/// Whether rows have columns of the uncertain constants. Each of these columns takes two runs, and no mode depends on them.
enum class Constants { held, varied };

/// These are the normal equations of the rows r = y - h(z), z = [w; eta]. z holds the p parameters, then the inputs' errors
/// in units of their tolerances, then the mesh's. The sums go over the frames, with the noise's precision R^-1.
struct NormalEquations {
  Eigen::MatrixXd information;            ///< Z^T R^-1 Z
  Eigen::VectorXd gradient;               ///< Z^T R^-1 r
  Eigen::MatrixXd constants;              ///< Z^T R^-1 C; each column of C is one constant's tolerance; 0 where held
  Eigen::MatrixXd constants_information;  ///< C^T R^-1 C
  Eigen::VectorXd constants_gradient;     ///< C^T R^-1 r
  double cost = 0.0;                      ///< r^T R^-1 r
  double rows = 0.0;
  std::map<int, double> force_noise;  ///< of each force sensor, its noise's variance over the stated one

  NormalEquations(Eigen::Index size, Eigen::Index constant_count);
  /// Multiplies all sums, because every frame stands for those that were left out.
  void repeat(double times);
  /// Adds the sums of another recording, so many times.
  void add(const NormalEquations& other, double times);
};

}  // namespace tissue_stiffness
