#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "fit/recording_fit.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"
#include "tools/bag_reader.hpp"

namespace tissue_stiffness {

/// A bag with the model's mesh. If the mesh is made from the first contour, the bag is read ahead up to it. Throws as
/// BagReader and build_mesh do. `checkpoint` is called before every frame that is read; an exception from it ends the
/// reading.
class RecordingReader {
 public:
  /// `most_images`: number of images of each sensor that are segmented; 0: all.
  RecordingReader(
      const std::string& file, const ModelSettings& settings, std::function<void()> checkpoint = [] {},
      std::size_t most_images = 0);

  /// Returns the next instant; nothing at the end.
  std::optional<Instant> next();
  const BagReader& reader() const { return reader_; }
  const TetMesh& mesh() const { return mesh_; }
  const std::function<void()>& checkpoint() const { return checkpoint_; }

 private:
  TetMesh make_mesh(const std::string& file, const ModelSettings& settings, std::size_t most_images);

  std::function<void()> checkpoint_;
  BagReader reader_;
  std::deque<Instant> ahead_;
  TetMesh mesh_;
};

/// Reads the rest of the bag, without frames that are empty or before the body is at rest. Throws InputError when no frame
/// is left. The recording's checkpoint is the reader's.
Recording read_recording(RecordingReader& reader, const ModelSettings& settings, const std::string& file);

}  // namespace tissue_stiffness
