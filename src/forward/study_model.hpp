#pragma once

#include <memory>

#include "forward/forward_model.hpp"
#include "forward/reduced_basis.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {

/// Returns whether a study may run all that the model has: it is linear, or linear but for contacts. Runs of others in full
/// take too long, so their studies see their linear form.
bool studied_in_full(const Model& model);

/// Makes what a study runs: the model itself where it is studied in full, else its linear form. `relative`: see
/// ReducedModel.
std::unique_ptr<ForwardModel> make_study_model(const Model& model, const BasisOptions& options = {},
                                               const ReducedModel* relative = nullptr);

/// Returns the reduced model of the linear form that is part of such a model.
const ReducedModel& linear_form_of(const ForwardModel& study_model);

}  // namespace tissue_stiffness
