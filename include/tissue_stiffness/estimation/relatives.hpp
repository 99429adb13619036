#pragma once

namespace tissue_stiffness {

class ReducedModel;

/// Models of the same body as the one at hand, in their reduced bases: what they have in common with it is taken over.
/// Null: none. They have to outlive what takes it over. The paper's scheme goes without.
struct Relatives {
  const ReducedModel* own = nullptr;    ///< on the same mesh
  const ReducedModel* finer = nullptr;  ///< on finer() of it, see mesh_error.hpp
};

}  // namespace tissue_stiffness
