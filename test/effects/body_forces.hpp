#pragma once

#include <Eigen/Geometry>
#include <string>

#include "../box_model.hpp"
#include "fem/facet_quadrature.hpp"
#include "forward/full_model.hpp"

namespace tissue_stiffness {

inline const std::string kInertia = "inertia: {density: 1000}";
inline const std::string kLinear = "elasticity: {law: linear, young_modulus: 3.0e4, poisson_ratio: 0.4}";

inline Eigen::VectorXd zero(const Model& model) {
  return Eigen::VectorXd::Zero(model.fem().dof_count());
}
inline Eigen::VectorXd prior(const Model& model) {
  return model.parameters().theta(model.parameters().prior_mean());
}

inline Eigen::Vector3d moment(const TetMesh& mesh, const Eigen::VectorXd& u, const Eigen::VectorXd& force) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < mesh.node_count(); ++i) {
    sum += (mesh.nodes.col(i) + u.segment<3>(3 * i)).cross(force.segment<3>(3 * i));
  }
  return sum;
}

/// Returns the whole force at displacement u, less the elastic one.
inline Eigen::VectorXd load(Model& model, double time, const Eigen::VectorXd& u) {
  Eigen::VectorXd elastic = zero(model);
  for (const Model::Part& part : model.parts()) {
    if (part.label != "elasticity" || !part.effect->finite_strain()->always_finite()) continue;
    part.effect->finite_strain()->add_finite_force({time, u, zero(model)}, part.parameters(prior(model)), elastic);
  }
  const ModelSystem system(model, prior(model));
  return system.force(time, u, zero(model)) - elastic + model.stiffness(prior(model)) * u;
}

}  // namespace tissue_stiffness
