#include "nodes/diagnosis_conversions.hpp"

#include "report/write_diagnosis.hpp"

namespace tissue_stiffness {
namespace {

MissingEffectMessage to_message(const MissingEffect& effect) {
  MissingEffectMessage out;
  out.effect = effect.effect;
  out.entry = effect.entry;
  for (const auto& [name, value] : effect.parameters) {
    out.parameter_names.push_back(name);
    out.parameter_values.push_back(value);
  }
  out.log_bayes_factor = effect.log_bayes_factor;
  out.probability = effect.probability;
  out.z = effect.z;
  out.p_value = effect.p_value;
  out.explained = effect.explained;
  out.held_out_rms_before = effect.held_out_rms_before;
  out.held_out_rms_after = effect.held_out_rms_after;
  for (const MissingEffect::Confusable& other : effect.confusable_with) {
    out.confusable_with.push_back(other.effect);
    out.cosines.push_back(other.cosine);
  }
  return out;
}

}  // namespace

DiagnosisMessage to_message(const Diagnosis& diagnosis, const std_msgs::Header& header) {
  DiagnosisMessage out;
  out.header = header;
  out.verdict = to_string(diagnosis.verdict);
  out.summary = diagnosis_sentence(diagnosis);
  out.set = diagnosis.set;
  out.probability_adequate = diagnosis.adequate;
  out.none_of_these = diagnosis.none_of_these;
  out.z = diagnosis.z;
  for (const MissingEffect& effect : diagnosis.candidates) out.candidates.push_back(to_message(effect));
  out.where = diagnosis.where;
  out.when = diagnosis.when;
  out.missing_force = diagnosis.force.words;
  out.next_experiment = diagnosis.next_experiment;
  const DiagnosisStep& given = diagnosis.steps.front();
  out.held_out_rms = given.held_out_rms;
  out.train_rms = given.train_rms;
  out.noise_floor = given.noise_floor;
  out.seconds = diagnosis.seconds;
  return out;
}

}  // namespace tissue_stiffness
