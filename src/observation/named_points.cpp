#include "observation/named_points.hpp"

namespace tissue_stiffness {

Prediction predict_named_points(const Observation& observation, double noise) {
  const Eigen::Index n = observation.ids.size();
  Prediction p;
  p.measured = Eigen::Map<const Eigen::VectorXd>(observation.points.data(), 3 * n);
  p.predicted.resize(3 * n);
  p.sigma = Eigen::VectorXd::Constant(3 * n, noise);
  p.places.resize(3, 3 * n);
  p.nodes.resize(3 * n);
  for (Eigen::Index i = 0; i < n; ++i) p.places.middleCols<3>(3 * i) = observation.points.col(i).replicate<1, 3>();
  return p;
}

}  // namespace tissue_stiffness
