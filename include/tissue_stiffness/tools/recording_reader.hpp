#pragma once

#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "tissue_stiffness/diagnosis/study.hpp"
#include "tissue_stiffness/tools/bag_reader.hpp"
#include "tissue_stiffness/types/tet_mesh.hpp"

namespace tissue_stiffness {

/// A bag with the model's mesh: reads ahead to the first contour when the mesh is made from it. Throws as BagReader and
/// build_mesh do. `checkpoint` is called before every frame that is read; what it throws ends the reading.
class RecordingReader {
 public:
  /// `most_images`: of each sensor that are segmented; 0: all.
  RecordingReader(
      const std::string& file, const ModelSettings& settings, std::function<void()> checkpoint = [] {},
      std::size_t most_images = 0);

  /// Nothing at the end.
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

/// Everything that is left in the bag, without frames that hold nothing or come before the body's rest. Throws InputError
/// when no frame is left. The recording's checkpoint is the reader's.
Recording read_recording(RecordingReader& reader, const ModelSettings& settings, const std::string& file);

}  // namespace tissue_stiffness
