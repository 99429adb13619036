#include "estimation/shared_parameters.hpp"

#include <algorithm>

#include "effects/registry.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

// Returns whether the parameter's effect differs between recordings by its nature.
bool of_recording(const Model& model, const std::string& name) {
  if (name.rfind("initial.", 0) == 0) return true;
  for (const EffectSettings& effect : model.settings().effects) {
    if (name.rfind(effect.label + ".", 0) == 0) return effect_spec(effect).of_recording;
  }
  return false;
}

bool same_prior(const Quantity& a, const Quantity& b) {
  return a.kind == b.kind && a.value == b.value && a.spread == b.spread;
}

std::string prior_text(const FreeParameter& free) {
  return formatted("%g %s, %s %g", free.prior.value, free.unit.c_str(),
                   free.prior.kind == Quantity::Kind::log_normal ? "factor" : "std", free.prior.spread);
}

// Throws InputError where a name of `own` is neither a parameter, an effect nor a topic of any recording.
void check_names(const Sharing& sharing, const std::vector<const Model*>& models) {
  for (const std::string& name : sharing.own) {
    const Sharing one{{}, {name}};
    const bool known = std::any_of(models.begin(), models.end(), [&](const Model* model) {
      const auto& free = model->parameters().free();
      const auto& inputs = model->loads().inputs();
      const auto& sensors = model->settings().observations;
      return std::any_of(free.begin(), free.end(), [&](const FreeParameter& p) { return one.is_own(p.name); }) ||
             std::any_of(inputs.begin(), inputs.end(), [&](const LoadInput& load) { return load.topic == name; }) ||
             std::any_of(sensors.begin(), sensors.end(), [&](const ObservationSettings& s) { return s.topic == name; });
    });
    if (!known) throw InputError("--own", name, "an estimated parameter, its effect, or a topic of the models");
  }
}

}  // namespace

bool Sharing::is_own(const std::string& name) const {
  return std::any_of(own.begin(), own.end(),
                     [&](const std::string& one) { return name == one || name.rfind(one + ".", 0) == 0; });
}

SharedParameters::SharedParameters(const Sharing& sharing, const std::vector<const Model*>& models) {
  check_names(sharing, models);
  for (std::size_t r = 0; r < models.size(); ++r) {
    columns_.emplace_back();
    for (const FreeParameter& free : models[r]->parameters().free()) {
      const bool own = sharing.is_own(free.name) || of_recording(*models[r], free.name);
      columns_.back().push_back(add(sharing, free, static_cast<int>(r), own));
    }
  }
}

Eigen::Index SharedParameters::add(const Sharing& sharing, const FreeParameter& free, int recording, bool own) {
  if (!own) {
    const auto known = std::find_if(all_.begin(), all_.end(),
                                    [&](const Parameter& p) { return p.recording < 0 && p.free.name == free.name; });
    if (known != all_.end()) {
      if (same_prior(known->free.prior, free.prior)) return known - all_.begin();
      throw InputError(sharing.recordings[static_cast<std::size_t>(recording)] + ": prior of " + free.name,
                       prior_text(free),
                       "that of the recordings before (" + prior_text(known->free) + "), or --own " + free.name);
    }
  }
  all_.push_back({free, own ? recording : -1});
  return size() - 1;
}

std::vector<FreeParameter> SharedParameters::free() const {
  std::vector<FreeParameter> out;
  for (const Parameter& p : all_) out.push_back(p.free);
  return out;
}

Eigen::VectorXd SharedParameters::prior_mean() const {
  Eigen::VectorXd out(size());
  for (Eigen::Index i = 0; i < size(); ++i) out[i] = all_[static_cast<std::size_t>(i)].free.prior_mean();
  return out;
}

Eigen::VectorXd SharedParameters::prior_std() const {
  Eigen::VectorXd out(size());
  for (Eigen::Index i = 0; i < size(); ++i) out[i] = all_[static_cast<std::size_t>(i)].free.prior_std();
  return out;
}

Eigen::VectorXd SharedParameters::of(std::size_t recording, const Eigen::VectorXd& w) const {
  Eigen::VectorXd out(static_cast<Eigen::Index>(columns_[recording].size()));
  for (Eigen::Index i = 0; i < out.size(); ++i) out[i] = w[columns_[recording][static_cast<std::size_t>(i)]];
  return out;
}

}  // namespace tissue_stiffness
