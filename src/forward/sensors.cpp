#include "forward/sensors.hpp"

namespace tissue_stiffness {

Sensors::Sensors(const TetMesh& mesh, const std::vector<ModelPart>& parts) : mesh_(&mesh) {
  for (const ModelPart& part : parts) {
    if (part.effect->sensor_model() != nullptr) members_.push_back({part.label, part.effect, part.indices, {}});
  }
}

double Sensors::delay(const Eigen::VectorXd& theta) const {
  double sum = 0.0;
  for (const ModelPart& part : members_) sum += part.effect->sensor_model()->delay(part.parameters(theta));
  return sum;
}

ObservedMotion Sensors::observe(const Eigen::VectorXd& theta, double since,
                                const Eigen::Ref<const Eigen::VectorXd>& displacement) const {
  ObservedMotion motion{*mesh_, since, displacement};
  for (const ModelPart& part : members_) part.effect->sensor_model()->observe(part.parameters(theta), motion);
  return motion;
}

}  // namespace tissue_stiffness
