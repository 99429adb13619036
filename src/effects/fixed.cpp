// Nodes of a region are held at rest.
#include "effects/registry.hpp"

namespace tissue_stiffness::effects {
namespace {

class Fixed : public Effect, public Support {
 public:
  Fixed(const Value& arguments, const EffectContext& context) : nodes_(context.region(arguments.at("region")).nodes) {}
  const Support* support() const override { return this; }
  std::vector<int> fixed_nodes() const override { return nodes_; }

 private:
  std::vector<int> nodes_;
};

}  // namespace

EffectSpec fixed_spec() {
  EffectSpec spec;
  spec.name = "fixed";
  spec.summary = "nodes held at rest";
  spec.formula = "u = 0 on the region";
  spec.source = "Dirichlet condition";
  spec.keys = {{"region", "nodes to hold"}};
  return spec;
}

std::unique_ptr<Effect> make_fixed(const Value& arguments, const EffectContext& context) {
  return std::make_unique<Fixed>(arguments, context);
}

}  // namespace tissue_stiffness::effects
