#include "tools/check_setup.hpp"

#include <algorithm>
#include <ostream>

#include "check/check_first_frame.hpp"
#include "check/check_images.hpp"
#include "check/check_mesh.hpp"
#include "check/check_motion.hpp"
#include "check/check_numbers.hpp"
#include "check/check_topics.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/bag_overview.hpp"
#include "tools/recording_reader.hpp"
#include "types/stop_request.hpp"

namespace tissue_stiffness {
namespace {

const std::string kModelFrame = "model";

SetupFindings check_bag(const ModelSettings& settings, const std::string& recording) {
  const std::vector<NeededTopic> needed = needed_topics(settings);
  const BagOverview bag = overview(recording, needed);
  SetupFindings findings = check_topics(needed, bag.topics, "the recording lacks");
  append(findings, check_frames(bag.frames, bag.transforms, kModelFrame));
  const SetupFindings clocks = check_clocks(bag.times);
  append(findings, clocks.empty() ? check_stops(bag.times) : clocks);
  for (const ObservationSettings& observation : settings.observations) {
    const auto images = bag.images.find(observation.topic);
    if (images != bag.images.end()) append(findings, check_images(observation, images->second));
  }
  return findings;
}

SetupFindings check_run(const ModelSettings& settings, const std::string& file, const std::function<void()>& checkpoint) {
  const bool clouds = std::any_of(settings.observations.begin(), settings.observations.end(),
                                  [](const auto& observation) { return !traits_of(observation.kind).image; });
  if (!clouds && !MotionStudy::applies(settings)) return {};
  RecordingReader reader(file, settings, checkpoint, MotionStudy::most_outlines);
  Recording recording = read_recording(reader, settings, file);
  const FirstFrames first{recording.first_stamp + settings.time.start, recording.frames.front(),
                          recording.frames.size() > 1 ? &recording.frames[1] : nullptr};
  const SetupFindings findings = check_first_frame(settings, reader.mesh(), first);
  if (!findings.empty()) return findings;
  try {
    return check_motion(settings, reader.mesh(),
                        {std::move(recording.frames), std::move(recording.loads), recording.first_stamp});
  } catch (const NumericalError&) {
    return {};  // the run itself says so, with what it tried
  }
}

}  // namespace

SetupFindings check_setup(const ModelSettings& settings, const std::string& recording,
                          const std::function<void()>& checkpoint) {
  SetupFindings findings = check_numbers(settings);
  append(findings, check_mesh_file(settings.mesh));
  if (!recording.empty()) append(findings, check_bag(settings, recording));
  if (recording.empty() || !findings.empty()) return findings;
  return check_run(settings, recording, checkpoint);
}

void warn_of_setup(const std::string& tool, const ModelSettings& settings, const std::string& recording,
                   const std::function<void()>& checkpoint, std::ostream& out) {
  try {
    for (const SetupFinding& finding : check_setup(settings, recording, checkpoint)) {
      out << tool << ": warning: " << finding.sentence << "\n";
    }
  } catch (const Interrupted&) {
    throw;
  } catch (const std::exception&) {  // the run stumbles over the same and says it better
  }
}

}  // namespace tissue_stiffness
