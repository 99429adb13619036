#pragma once

#include <Eigen/Core>
#include <string>

namespace tissue_stiffness {

/// One measured value of a load that drives the model.
struct LoadSample {
  std::string topic;
  double time = 0.0;      ///< [s] on the recording's clock
  Eigen::VectorXd value;  ///< pressure: 1 value [Pa]; wrench: force [N] and torque [N m], in the model frame
};

/// A topic from which the model needs load samples.
struct LoadInput {
  enum class Kind { pressure, wrench };
  std::string topic;
  Kind kind = Kind::pressure;
};

}  // namespace tissue_stiffness
