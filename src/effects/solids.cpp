#include "effects/solids.hpp"

namespace tissue_stiffness {

Solids::Solids(const EffectContext& context, int own) : own_(own) {
  for (const std::vector<int>& elements : context.solids) {
    inside_.emplace_back(static_cast<std::size_t>(context.fem.element_count()), char{0});
    for (const int e : elements) inside_.back()[static_cast<std::size_t>(e)] = 1;
    solids_.emplace_back(context.fem, elements);
  }
}

double mean_young_modulus(const Parameters& p, int own, std::size_t solids) {
  double sum = 0.0;
  for (std::size_t s = 0; s < solids; ++s) sum += p[own + 2 * static_cast<Eigen::Index>(s)];
  return sum / static_cast<double>(solids);
}

}  // namespace tissue_stiffness
