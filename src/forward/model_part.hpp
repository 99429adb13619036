#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "effects/effect.hpp"

namespace tissue_stiffness {

/// One effect in the model, with its terms and the positions of its parameters in theta.
struct ModelPart {
  std::string label;
  std::shared_ptr<const Effect> effect;
  std::vector<int> indices;  ///< indices of its parameters in theta
  LinearTerms terms;

  Eigen::VectorXd parameters(const Eigen::VectorXd& theta) const;
  /// Returns nodes of other effects that it releases while is_compliant() is true of its parameters.
  std::vector<int> compliant_nodes() const;
  bool is_compliant(const Eigen::VectorXd& parameters) const;
};

}  // namespace tissue_stiffness
