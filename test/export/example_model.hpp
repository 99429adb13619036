#pragma once

#include <memory>

#include "../box_model.hpp"
#include "export/exported_model.hpp"

namespace tissue_stiffness {

inline Eigen::VectorXd wrench(double x, double y, double z) {
  Eigen::VectorXd value = Eigen::VectorXd::Zero(6);
  value.head<3>() << x, y, z;
  return value;
}

/// The bar with a soft near half and a stiff far one, held at its clamp, pulled at its tip. The force is largest at 12 s on
/// the clock, 2 s after the recording's first stamp.
inline std::vector<std::string> bar_effects(const std::vector<std::string>& more = {}, const std::string& law = "linear") {
  std::vector<std::string> out = {
      "inertia: {density: 1050}",
      "elasticity: {law: " + law + ", region: near, young_modulus: 10.0e3, poisson_ratio: 0.3}",
      "elasticity: {law: " + law + ", region: far, young_modulus: 40.0e3, poisson_ratio: 0.45}",
      "fixed: {region: clamp}",
      "traction: {region: tip, topic: /tool/wrench}",
      "gravity: {acceleration: [1.0, 0, -9.81]}",
  };
  out.insert(out.end(), more.begin(), more.end());
  return out;
}

inline std::unique_ptr<Model> bar_model(const std::vector<std::string>& effects, const TetMesh& mesh = bar_mesh()) {
  auto model = std::make_unique<Model>(box_settings(effects), mesh);
  model->loads().drive(10.0, {{"/tool/wrench", 10.0, wrench(0.0, 0.0, 0.0)},
                              {"/tool/wrench", 12.0, wrench(0.02, 0.01, -0.04)},
                              {"/tool/wrench", 14.0, wrench(0.01, 0.0, 0.02)}});
  return model;
}

inline ExportedModel export_bar(const std::vector<std::string>& effects, double time = 12.0) {
  const auto model = bar_model(effects);
  return export_model(*model, model->parameters().known(), time);
}

}  // namespace tissue_stiffness
