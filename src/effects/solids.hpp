#pragma once

#include <vector>

#include "effects/effect.hpp"
#include "fem/neo_hookean.hpp"

namespace tissue_stiffness {

/// The model's elasticities, for an effect that alters their law and needs_elasticity(). It knows the elements of each
/// elasticity, and finds its parameters after the effect's own.
class Solids {
 public:
  /// `own`: number of the effect's own parameters, counting the components of vectors.
  Solids(const EffectContext& context, int own);

  std::size_t count() const { return solids_.size(); }
  bool holds(std::size_t solid, int element) const { return inside_[solid][static_cast<std::size_t>(element)] != 0; }
  const NeoHookean& finite(std::size_t solid) const { return solids_[solid]; }
  int modulus_index(std::size_t solid) const { return own_ + 2 * static_cast<int>(solid); }
  int ratio_index(std::size_t solid) const { return modulus_index(solid) + 1; }
  double modulus(std::size_t solid, const Parameters& p) const { return p[modulus_index(solid)]; }
  double ratio(std::size_t solid, const Parameters& p) const { return p[ratio_index(solid)]; }
  Lame moduli(std::size_t solid, const Parameters& p) const { return lame(modulus(solid, p), ratio(solid, p)); }
  /// Calls act(solid) for each elasticity that holds the element.
  template <typename Act>
  void at(int element, const Act& act) const {
    for (std::size_t s = 0; s < count(); ++s) {
      if (holds(s, element)) act(s);
    }
  }

 private:
  int own_;
  std::vector<std::vector<char>> inside_;
  std::vector<NeoHookean> solids_;
};

/// Returns the mean Young's modulus of all elasticities, whose parameters follow the `own` ones of an effect that
/// needs_elasticity() [Pa].
double mean_young_modulus(const Parameters& p, int own, std::size_t solids);

}  // namespace tissue_stiffness
