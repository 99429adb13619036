#include "forward/model_part.hpp"

namespace tissue_stiffness {

Eigen::VectorXd ModelPart::parameters(const Eigen::VectorXd& theta) const {
  Eigen::VectorXd own(static_cast<Eigen::Index>(indices.size()));
  for (std::size_t i = 0; i < indices.size(); ++i) own[static_cast<Eigen::Index>(i)] = theta[indices[i]];
  return own;
}

std::vector<int> ModelPart::compliant_nodes() const {
  const Support* support = effect->support();
  return support != nullptr ? support->compliant_nodes() : std::vector<int>{};
}

bool ModelPart::is_compliant(const Eigen::VectorXd& parameters) const {
  const Support* support = effect->support();
  return support != nullptr && support->is_compliant(parameters);
}

}  // namespace tissue_stiffness
