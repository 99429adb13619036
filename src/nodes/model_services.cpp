#include "nodes/model_services.hpp"

#include <algorithm>

#include "effects/registry.hpp"
#include "nodes/diagnosis_conversions.hpp"
#include "nodes/estimator_inputs.hpp"
#include "nodes/force_view.hpp"
#include "settings/inside_folder.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// No topic is subscribed to later on, so an added effect can only use topics that the node already listens to.
void require_known_topics(const ModelSettings& before, const ModelSettings& after) {
  const std::vector<LoadInput> known = load_topics(before);
  for (const LoadInput& input : load_topics(after)) {
    const bool heard = std::any_of(known.begin(), known.end(), [&](const LoadInput& k) { return k.topic == input.topic; });
    if (!heard) throw InputError("topic", input.topic, "a load's topic that the model file names");
  }
}

}  // namespace

ModelServices::ModelServices(const ros::NodeHandle& node, std::string directory, std::string model_frame,
                             const ModelCheck::Options& options, Change change)
    : directory_(std::move(directory)),
      model_frame_(std::move(model_frame)),
      change_(std::move(change)),
      node_(node),
      publisher_(node_.advertise<DiagnosisMessage>("diagnosis", 1, true)),
      force_publisher_(node_.advertise<visualization_msgs::Marker>("missing_force", 1, true)),
      check_(options, [this](const Diagnosis& diagnosis, double stamp) { publish(diagnosis, stamp); }),
      spinner_(1, &queue_) {
  node_.setCallbackQueue(&queue_);
  services_ = {node_.advertiseService("diagnose", &ModelServices::on_diagnose, this),
               node_.advertiseService("add_effect", &ModelServices::on_add, this),
               node_.advertiseService("remove_effect", &ModelServices::on_remove, this),
               node_.advertiseService("list_effects", &ModelServices::on_list, this)};
  spinner_.start();
}

ModelServices::~ModelServices() {
  check_.stop();  // lets a service that waits for it return
  spinner_.stop();
}

void ModelServices::start(const ModelSettings& settings, const ModelSettings& begun, const TetMesh& mesh) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    settings_ = settings;
  }
  check_.start(begun, mesh);
}

void ModelServices::publish(const Diagnosis& diagnosis, double stamp) {
  std_msgs::Header header;
  header.stamp.fromSec(stamp);
  header.frame_id = model_frame_;
  DiagnosisMessage message = to_message(diagnosis, header);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    message.added = added_;
  }
  publisher_.publish(message);
  force_publisher_.publish(force_marker(diagnosis.force, header));
}

bool ModelServices::on_diagnose(Diagnose::Request&, Diagnose::Response& response) {
  try {
    response.diagnosis = to_message(check_.check(), {});
    response.diagnosis.header.frame_id = model_frame_;
    response.message = response.diagnosis.summary;
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

std::string ModelServices::change_model(const std::function<std::string(ModelSettings&)>& edit) {
  ModelSettings changed;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!settings_) throw InputError("effect", "no mesh yet", "a running model");
    changed = *settings_;
  }
  const ModelSettings before = changed;
  const std::string message = edit(changed);
  require_known_topics(before, changed);
  change_(changed);
  return message;
}

// Returns the caller's entry, or the one that the last diagnosis found for an effect with this name.
std::string ModelServices::entry_of(const std::string& effect) const {
  if (effect.find(':') != std::string::npos) return effect;
  const std::optional<Diagnosis> last = check_.last();
  std::string names;
  for (const MissingEffect& candidate : last ? last->candidates : std::vector<MissingEffect>{}) {
    if (candidate.effect == effect) return candidate.entry;
    names += (names.empty() ? "" : ", ") + candidate.effect;
  }
  throw InputError("effect", effect,
                   names.empty() ? "an entry of a model file (\"name: {key: value}\"), as there is no diagnosis yet"
                                 : "an entry of a model file, or a candidate of the last diagnosis: " + names);
}

bool ModelServices::on_add(AddEffect::Request& request, AddEffect::Response& response) {
  try {
    std::string name;
    response.message = change_model([&](ModelSettings& model) {
      const std::string entry = entry_of(request.effect);
      add_effect(model, entry);
      require_files_inside(model.effects.back().arguments, directory_);
      name = model.effects.back().name;
      return "added " + entry;
    });
    const std::lock_guard<std::mutex> lock(mutex_);
    added_.push_back(name);
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

bool ModelServices::on_remove(RemoveEffect::Request& request, RemoveEffect::Response& response) {
  try {
    response.message = change_model([&](ModelSettings& model) {
      remove_effect(model, request.effect);
      return "removed " + request.effect;
    });
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto last = std::find(added_.rbegin(), added_.rend(), request.effect);
    if (last != added_.rend()) added_.erase(std::next(last).base());
    response.success = 1;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

bool ModelServices::on_list(ListEffects::Request&, ListEffects::Response& response) {
  for (const EffectSpec& spec : effect_specs()) {
    response.library.push_back(spec.name);
    response.summaries.push_back(spec.summary);
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  if (settings_) {
    for (const EffectSettings& effect : settings_->effects) response.running.push_back(effect.label);
  }
  response.added = added_;
  return true;
}

}  // namespace tissue_stiffness
