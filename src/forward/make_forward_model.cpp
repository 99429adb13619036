#include <algorithm>

#include "forward/contact_model.hpp"
#include "forward/extra_force.hpp"
#include "forward/extrapolated_model.hpp"
#include "forward/first_order_model.hpp"
#include "forward/full_model.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

std::unique_ptr<ForwardModel> make_forward_model(const Model& model) {
  return make_forward_model(model, BasisOptions());
}

std::unique_ptr<ForwardModel> make_forward_model(const Model& model, const BasisOptions& basis,
                                                 const ForwardModel* relative) {
  const auto* first_order = dynamic_cast<const FirstOrderModel*>(relative);
  const auto* reduced = first_order != nullptr ? &first_order->reduced() : dynamic_cast<const ReducedModel*>(relative);
  const bool left_out = basis.nonlinear == BasisOptions::Nonlinear::left_out;
  if (!model.nonlinear() || left_out) return std::make_unique<ReducedModel>(model, basis, reduced);
  if (basis.nonlinear == BasisOptions::Nonlinear::first_order) {
    return std::make_unique<FirstOrderModel>(model, basis, reduced);
  }
  if (ContactModel::suits(model)) return std::make_unique<ContactModel>(model, basis, reduced);
  FullModel::Options options;
  options.steps_per_frame = basis.steps_per_frame;
  options.step = model.settings().time.step;
  const auto& parts = model.parts();
  if (basis.extrapolated && options.step <= 0.0 && std::all_of(parts.begin(), parts.end(), has_linear_form))
    return std::make_unique<ExtrapolatedModel>(model, options);
  return std::make_unique<FullModel>(model, options);
}

}  // namespace tissue_stiffness
