#include "check/check_topics.hpp"

#include <algorithm>
#include <optional>

#include "effects/registry.hpp"
#include "settings/suggestion.hpp"

namespace tissue_stiffness {
namespace {

std::string last_part(const std::string& name) {
  return name.substr(name.find_last_of('/') + 1);
}

/// Returns a name that is spelled nearly alike, or else one that is only in another namespace.
std::string similar_name(const std::string& name, const std::vector<Topic>& there) {
  std::vector<std::string> names;
  for (const Topic& topic : there) names.push_back(topic.name);
  const std::string near = closest_word(name, names);
  if (!near.empty()) return near;
  const auto same = [&](const std::string& other) { return last_part(other) == last_part(name); };
  const auto found = std::find_if(names.begin(), names.end(), same);
  return found == names.end() ? "" : *found;
}

SetupFinding missing(const NeededTopic& needed, const std::vector<Topic>& there, const std::string& lack) {
  const Topic& topic = needed.topic;
  std::vector<std::string> alike;
  for (const Topic& other : there) {
    if (other.type == topic.type) alike.push_back(other.name);
  }
  const std::string similar = similar_name(topic.name, there);
  return {topic.name, needed.key + ": " + lack + " the topic " + topic.name +
                          (similar.empty() ? "" : " (did you mean `" + similar + "`?)") + "; of its type, " + topic.type +
                          ", there is " + join_words(alike) + "; mend the name or remap it."};
}

}  // namespace

std::vector<NeededTopic> needed_topics(const ModelSettings& settings) {
  std::vector<NeededTopic> needed;
  const auto add = [&](const std::string& key, const std::string& name, const std::string& type) {
    const bool known = std::any_of(needed.begin(), needed.end(), [&](const auto& n) { return n.topic.name == name; });
    if (!known) needed.push_back({key, {name, type}});
  };
  for (std::size_t i = 0; i < settings.observations.size(); ++i) {
    const ObservationSettings& observation = settings.observations[i];
    const std::string key = "observations[" + std::to_string(i) + "]";
    const ObservationTraits& traits = traits_of(observation.kind);
    add(key + "." + traits.name + (traits.image ? ".image" : ".topic"), observation.topic, traits.message);
    if (traits.image) add(key + "." + traits.name + ".camera_info", observation.camera_info, "sensor_msgs/CameraInfo");
  }
  for (EffectSettings effect : settings.effects) {  // a copy: asking marks keys as known
    const std::optional<LoadInput::Kind> kind = effect_spec(effect).load;
    if (!effect.arguments.has("topic") || !kind) continue;
    const Value& topic = effect.arguments.at("topic");
    add(topic.path(), topic.as_text(), message_type(*kind));
  }
  return needed;
}

SetupFindings check_topics(const std::vector<NeededTopic>& needed, const std::vector<Topic>& there,
                           const std::string& lack) {
  SetupFindings findings;
  for (const NeededTopic& need : needed) {
    const auto found = std::find_if(there.begin(), there.end(), [&](const Topic& t) { return t.name == need.topic.name; });
    if (found == there.end()) {
      findings.push_back(missing(need, there, lack));
    } else if (found->type != need.topic.type) {
      findings.push_back({need.topic.name, need.key + ": the topic " + need.topic.name + " has messages of " + found->type +
                                               ", and the model needs " + need.topic.type + "; name another topic."});
    }
  }
  return findings;
}

SetupFindings check_frames(const std::map<std::string, std::string>& frames,
                           const std::vector<std::pair<std::string, std::string>>& transforms,
                           const std::string& model_frame) {
  std::vector<std::string> joined{model_frame};
  const auto has = [&](const std::string& name) { return std::find(joined.begin(), joined.end(), name) != joined.end(); };
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& [parent, child] : transforms) {
      if (has(parent) == has(child)) continue;
      joined.push_back(has(parent) ? child : parent);
      grows = true;
    }
  }
  SetupFindings findings;
  for (const auto& [topic, frame] : frames) {
    if (has(frame)) continue;
    findings.push_back({topic, topic + ": no transform on /tf or /tf_static joins its frame `" + frame + "`" +
                                   did_you_mean(frame, joined) + " with `" + model_frame + "`; joined with that is " +
                                   join_words(joined) +
                                   "; publish the sensor's pose, as static_transform_publisher does, or mend "
                                   "the messages' frame_id."});
  }
  return findings;
}

}  // namespace tissue_stiffness
