#pragma once

#include <atomic>
#include <cstddef>
#include <future>
#include <memory>
#include <optional>
#include <string>

#include "estimation/input_study.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/reuse_sources.hpp"

namespace tissue_stiffness {

/// Studies decide when the mesh and the errors of the inputs are studied, and run that job: one at a time, in the
/// background or at once. A study that fails leaves the last answer.
class Studies {
 public:
  /// The model has to outlive this.
  Studies(const Model& model, const ReuseSources& relatives);
  ~Studies();
  Studies(const Studies&) = delete;
  Studies& operator=(const Studies&) = delete;

  struct Subjects {
    bool mesh = false, inputs = false;
    bool any() const { return mesh || inputs; }
  };
  /// Returns what has to be studied with so many frames. `anew`: the last study of the inputs no longer holds; `replaying`:
  /// no later study will use what this one builds; `background`: the inputs do not wait for the mesh.
  Subjects due(std::size_t frames, bool anew, bool replaying, bool background);

  using Question = MeshError::Question;
  /// Begins the studies. `beside` runs them on a thread of their own; otherwise `take` does the work. `replaying` is that
  /// of `due`.
  void begin(Question question, Subjects subjects, bool replaying, bool beside);
  bool under_way() const { return work_.valid(); }
  bool finished() const;

  struct Answers {
    std::optional<MeshError::Answer> mesh;     ///< the last one
    std::optional<InputStudy::Answer> inputs;  ///< a new one; empty: none
  };
  /// Waits for the end.
  Answers take();
  /// Gives up what is under way, and starts again as if there had been no frame.
  void reset();

  /// Says why the mesh's error is not known; empty: it is, or will be.
  std::string mesh_unknown() const { return why_not_ + failure_; }

 private:
  void give_up();
  void study_mesh(Question& question, Subjects subjects, bool once);
  void study_inputs(const Question& question);

  const Model& model_;
  const ReuseSources relatives_;
  const std::string why_not_;  ///< reason against a study of the mesh; empty: it can be studied
  std::string failure_;        ///< of the last study of the mesh; with more frames the next one may settle
  std::size_t last_mesh_ = 0, last_inputs_ = 0;  ///< number of frames at that time
  bool mesh_is_newer_ = false;                   ///< than the study of the inputs, which did not know it
  bool mesh_answered_ = false;
  /// The job owns these while it is under way.
  struct {
    std::unique_ptr<MeshError> mesh_error;
    std::unique_ptr<InputStudy> input_study;
    Answers answers;
    std::string failure;
  } job_;
  std::atomic<bool> given_up_{false};
  std::future<void> work_;  ///< declared last, because it uses the members above
};

}  // namespace tissue_stiffness
