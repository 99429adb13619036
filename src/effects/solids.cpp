#include "effects/solids.hpp"

namespace tissue_stiffness {

Solids::Solids(const EffectContext& context, int own) : own_(own) {
  for (const std::vector<int>& elements : context.solids) {
    inside_.emplace_back(static_cast<std::size_t>(context.fem.element_count()), char{0});
    for (const int e : elements) inside_.back()[static_cast<std::size_t>(e)] = 1;
    solids_.emplace_back(context.fem, elements);
  }
}

}  // namespace tissue_stiffness
