#include "tissue_stiffness/forward/full_model.hpp"
#include "tissue_stiffness/forward/reduced_model.hpp"

namespace tissue_stiffness {

std::unique_ptr<ForwardModel> make_forward_model(const Model& model) {
  if (!model.nonlinear()) return std::make_unique<ReducedModel>(model);
  FullModel::Options options;
  options.step = model.settings().time.step;
  return std::make_unique<FullModel>(model, options);
}

}  // namespace tissue_stiffness
