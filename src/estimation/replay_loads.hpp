#pragma once

#include <Eigen/Core>

#include "forward/model.hpp"
#include "types/replay.hpp"

namespace tissue_stiffness {

/// Adds to a replay what holds and moves the body of a model at theta, whose loads are known: its fixed places, the forces
/// of `traction` and `pressure` as measured, and prescribed motions. Forces are those on the body at rest.
void add_loads(const Model& model, const Eigen::VectorXd& theta, Replay& replay);

}  // namespace tissue_stiffness
