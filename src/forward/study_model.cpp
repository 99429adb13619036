#include "forward/study_model.hpp"

#include "forward/contact_model.hpp"

namespace tissue_stiffness {

bool studied_in_full(const Model& model) {
  return !model.nonlinear() || ContactModel::suits(model);
}

std::unique_ptr<ForwardModel> make_study_model(const Model& model, const BasisOptions& options,
                                               const ReducedModel* relative) {
  if (ContactModel::suits(model)) return std::make_unique<ContactModel>(model, options, relative);
  return std::make_unique<ReducedModel>(model, options.linear_form(), relative);
}

const ReducedModel& linear_form_of(const ForwardModel& study_model) {
  const auto* contact = dynamic_cast<const ContactModel*>(&study_model);
  return contact != nullptr ? contact->reduced() : dynamic_cast<const ReducedModel&>(study_model);
}

}  // namespace tissue_stiffness
