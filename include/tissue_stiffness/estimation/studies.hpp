#pragma once

#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "tissue_stiffness/estimation/input_study.hpp"
#include "tissue_stiffness/estimation/mesh_error.hpp"
#include "tissue_stiffness/estimation/relatives.hpp"

namespace tissue_stiffness {

/// When the mesh and the errors of the inputs are studied, and the job that does it: one at a time, beside the frames or
/// at once. A study that fails leaves the last answer.
class Studies {
 public:
  /// The model has to outlive this.
  Studies(const Model& model, const Relatives& relatives);

  struct Subjects {
    bool mesh = false, inputs = false;
    bool any() const { return mesh || inputs; }
  };
  /// What has to be studied with so many frames. `anew`: the last study of the inputs no longer holds; `replaying`: no
  /// later study will use what this one builds; `background`: the inputs do not wait for the mesh.
  Subjects due(std::size_t frames, bool anew, bool replaying, bool background);

  using Question = MeshError::Question;
  /// Begins; `beside`: on a thread of its own, otherwise `take` does the work. `replaying`: as for `due`.
  void begin(Question question, Subjects subjects, bool replaying, bool beside);
  bool under_way() const { return work_.valid(); }
  bool finished() const;

  struct Answers {
    std::optional<MeshError::Answer> mesh;     ///< the last one
    std::optional<InputStudy::Answer> inputs;  ///< a new one; empty: none
  };
  /// Waits for the end.
  Answers take();
  /// Waits for the end, and begins as if there had been no frame.
  void reset();

  /// Why the mesh's error is not known; empty: it is, or will be.
  std::string mesh_unknown() const { return why_not_ + failure_; }

 private:
  void study_mesh(Question& question, Subjects subjects, bool once);
  void study_inputs(const Question& question);

  const Model& model_;
  const Relatives relatives_;
  const std::string why_not_;                    ///< the mesh cannot be studied; empty: it can
  std::string failure_;                          ///< of the last study of the mesh; more frames may settle the next
  std::size_t last_mesh_ = 0, last_inputs_ = 0;  ///< frames that there were then
  bool mesh_is_newer_ = false;                   ///< than the study of the inputs, which did not know it
  bool mesh_answered_ = false;
  /// The job's own while it is under way.
  struct {
    std::unique_ptr<MeshError> mesh_error;
    std::unique_ptr<InputStudy> input_study;
    Answers answers;
    std::string failure;
  } job_;
  std::future<void> work_;  ///< last: it uses the members above
};

}  // namespace tissue_stiffness
