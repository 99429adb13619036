#pragma once

namespace tissue_stiffness {

class ReducedModel;

/// These are models of the body at hand, in their reduced bases. What they have in common with the new model is taken over.
/// Null means none. They have to outlive what takes it over. The paper's scheme reuses nothing.
struct ReuseSources {
  const ReducedModel* own = nullptr;    ///< on the same mesh
  const ReducedModel* finer = nullptr;  ///< on refined_mesh() of that mesh, see mesh_error.hpp
};

}  // namespace tissue_stiffness
