// Time stepping: order, and the energy of a bar that swings.
#include <cmath>

#include "elastic_body.hpp"
#include "figures.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Law = ElasticBody::Law;

constexpr double kDensity = 1000.0;
const Lame kLame = lame(30e3, 0.4);

ElasticBody clamped_bar(const TetMesh& mesh, Law law) {
  return {mesh, law, kLame, kDensity, clamped_dofs(mesh)};
}

// Bent by its own weight, then let go without it.
DynamicState released(ElasticBody& body, double acceleration) {
  const Eigen::VectorXd load = weight(body, acceleration), zero = Eigen::VectorXd::Zero(load.size());
  DynamicState state;
  state.displacement = zero;
  for (const double part : {0.25, 0.5, 0.75, 1.0}) {
    body.set_load(part * load);
    state.displacement = equilibrium(body, zero, state.displacement);
  }
  state.velocity = zero;
  body.set_load(zero);
  return state;
}

// Largest change of the energy over a second, relative to the energy at the start.
double drift(ElasticBody& body, double acceleration, double step) {
  DynamicState state = released(body, acceleration);
  GeneralizedAlpha newmark(body, 1.0, 1e-12);
  newmark.initialise(state);
  const double start = body.energy(state.displacement, state.velocity);
  double worst = 0.0, fastest = 0.0;
  while (state.time < 1.0 - 0.5 * step) {
    newmark.step(state, step);
    worst = std::max(worst, std::abs(body.energy(state.displacement, state.velocity) / start - 1.0));
    fastest = std::max(fastest, body.kinetic_energy(state.velocity) / start);
  }
  if (fastest < 0.5) throw NumericalError("the bar did not swing");
  return worst;
}

Eigen::VectorXd run(ElasticBody& body, double radius, double duration, int steps) {
  DynamicState state = released(body, 3.0);
  GeneralizedAlpha stepper(body, radius, 1e-13);
  stepper.initialise(state);
  for (int k = 0; k < steps; ++k) stepper.step(state, duration / steps);
  return state.displacement;
}

// log2 of the ratio of successive differences when the step is halved.
double order_in_time(ElasticBody& body, double radius) {
  const double duration = 0.12;
  const Eigen::VectorXd coarse = run(body, radius, duration, 60), middle = run(body, radius, duration, 120),
                        fine = run(body, radius, duration, 240);
  return std::log2((coarse - middle).norm() / (middle - fine).norm());
}

}  // namespace

std::vector<Figure> time_figures() {
  const TetMesh mesh = make_box_mesh({0.10, 0.02, 0.02}, 4, 1, 1, 2);
  std::vector<Figure> figures;
  for (const Law law : {Law::linear, Law::neo_hookean}) {
    const std::string name = law == Law::linear ? "linear" : "neo-Hookean";
    ElasticBody free = clamped_bar(mesh, law);
    figures.push_back({"energy drift over 1 s, " + name, drift(free, 3.0, 1e-3), 0.0, law == Law::linear ? 1e-8 : 1e-4});
    for (const double radius : {1.0, 0.7}) {
      ElasticBody damped = clamped_bar(mesh, law);
      damped.set_damping(2.0 * damped.mass() + 1e-3 * linear_stiffness(damped.fem(), kLame));
      const std::string scheme = radius < 1.0 ? ", generalised-alpha" : ", Newmark";
      figures.push_back({"order in time, " + name + scheme, order_in_time(damped, radius), 1.9, 2.1});
    }
  }
  return figures;
}

}  // namespace tissue_stiffness
