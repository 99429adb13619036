// Estimates Young's modulus from arrays, without ROS. A bar of 12 kPa is pulled slowly, and its end is measured.
#include <iostream>

#include "tissue_stiffness/estimation/estimator.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"

using namespace tissue_stiffness;

int main(int, char** arguments) {
  const ModelSettings model = load_model(arguments[1]);
  const TetMesh mesh = build_mesh(model.mesh);
  Estimator estimator(model, mesh);
  const int end[] = {10, 21, 32, 43, 54, 65, 76, 87, 98};  // vertices of bar.vtk
  StepResult result;
  for (int frame = 0; frame <= 60; ++frame) {
    const double time = frame / 30.0, force = 0.1 * time;            // [s], [N]
    const double elongation = force / (0.02 * 0.02) * 0.1 / 12.0e3;  // [m], stress times length over modulus
    estimator.add_load({"force", time, Eigen::VectorXd::Unit(6, 0) * force});
    Observation seen;
    seen.time = time;
    seen.ids = Eigen::Map<const Eigen::VectorXi>(end, 9);
    seen.points.resize(3, 9);
    for (int i = 0; i < 9; ++i) seen.points.col(i) = mesh.nodes.col(end[i]) + elongation * Eigen::Vector3d::UnitX();
    result = estimator.step({time, {seen}});
  }
  const ParameterEstimate& modulus = result.estimate.parameters.front();
  std::cout << modulus.name << " = " << modulus.mean << " Pa (" << modulus.lower95 << " to " << modulus.upper95 << "), "
            << to_string(result.estimate.state) << "\n";
}
