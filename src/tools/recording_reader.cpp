#include "tools/recording_reader.hpp"

#include <utility>

#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

RecordingReader::RecordingReader(const std::string& file, const ModelSettings& settings, std::function<void()> checkpoint,
                                 std::size_t most_images)
    : checkpoint_(std::move(checkpoint)), reader_(file, settings), mesh_(make_mesh(file, settings, most_images)) {
  reader_.set_mesh(mesh_);
}

std::optional<Instant> RecordingReader::next() {
  checkpoint_();
  if (ahead_.empty()) return reader_.next();
  Instant instant = std::move(ahead_.front());
  ahead_.pop_front();
  return instant;
}

TetMesh RecordingReader::make_mesh(const std::string& file, const ModelSettings& settings, std::size_t most_images) {
  if (most_images > 0) reader_.thin_images(most_images);
  if (settings.mesh.source == MeshSettings::Source::file) return build_mesh(settings.mesh, checkpoint_);
  std::string reason = "no contour observed by the model";
  while (std::optional<Instant> instant = reader_.next()) {
    checkpoint_();
    if (!instant->reason.empty()) reason = instant->reason;
    ahead_.push_back(std::move(*instant));
    for (const Observation& observation : ahead_.back().frame.observations) {
      if (observation.contour) return build_mesh(settings.mesh, *observation.contour, *observation.camera, checkpoint_);
    }
  }
  throw InputError(file, "no outline to make the mesh from (" + reason + ")", "an image that shows the body");
}

Recording read_recording(RecordingReader& reader, const ModelSettings& settings, const std::string& file) {
  Recording out;
  out.first_stamp = reader.reader().first_stamp();
  out.checkpoint = reader.checkpoint();
  std::string reason = "the bag is empty";
  while (std::optional<Instant> instant = reader.next()) {
    for (LoadSample& sample : instant->loads) out.loads.push_back(std::move(sample));
    if (!instant->reason.empty()) reason = instant->reason;
    if (instant->frame.observations.empty() || instant->frame.time < out.first_stamp + settings.time.start) continue;
    out.frames.push_back(std::move(instant->frame));
  }
  if (out.frames.empty()) throw InputError(file, "no usable frame (" + reason + ")", "at least one");
  return out;
}

}  // namespace tissue_stiffness
