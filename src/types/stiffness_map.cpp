#include "tissue_stiffness/types/stiffness_map.hpp"

#include <algorithm>

namespace tissue_stiffness {

int StiffnessMap::identified() const {
  return static_cast<int>(
      std::count_if(patches.begin(), patches.end(), [](const StiffnessPatch& patch) { return patch.identified; }));
}

}  // namespace tissue_stiffness
