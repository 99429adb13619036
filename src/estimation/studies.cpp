#include "estimation/studies.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "estimation/low_priority.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kFirstMesh = 4, kFirstInputs = 4;  // frames before the first study
constexpr std::size_t kMeshGrowth = 2;                   // growth of the recording from one study to the next
constexpr double kInputGrowth = 1.5;

}  // namespace

Studies::Studies(const Model& model, const ReuseSources& relatives)
    : model_(model), relatives_(relatives), why_not_(MeshError::why_not(model)) {}

Studies::~Studies() {
  give_up();
}

Studies::Subjects Studies::due(std::size_t frames, bool anew, bool replaying, bool background) {
  const bool kept = job_.mesh_error != nullptr || replaying;
  const bool mesh =
      why_not_.empty() && (frames >= std::max(kFirstMesh, kMeshGrowth * last_mesh_) || (mesh_answered_ && !kept));
  const bool inputs =
      anew || mesh_is_newer_ ||
      static_cast<double>(frames) >= std::max<double>(kFirstInputs, kInputGrowth * static_cast<double>(last_inputs_));
  if (!mesh && !inputs) return {};
  Subjects out;
  // In a node the quick study does not wait for the long one.
  out.inputs = inputs || !background;
  out.mesh = mesh && !(background && inputs);
  mesh_is_newer_ = out.mesh && !out.inputs;
  if (out.mesh) last_mesh_ = frames;
  if (out.inputs) last_inputs_ = frames;
  return out;
}

void Studies::begin(Question question, Subjects subjects, bool replaying, bool beside) {
  question.checkpoint = [this] {
    if (given_up_) throw NumericalError("given up");
  };
  const auto work = [this, subjects, replaying, asked = std::make_shared<Question>(std::move(question))] {
    if (subjects.mesh || job_.mesh_error) study_mesh(*asked, subjects, replaying);
    if (subjects.inputs) study_inputs(*asked);
  };
  work_ = beside ? at_low_priority(work) : std::async(std::launch::deferred, work);
}

bool Studies::finished() const {
  return work_.valid() && work_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

void Studies::study_mesh(Question& question, Subjects subjects, bool once) {
  try {
    if (!job_.mesh_error) {
      job_.mesh_error =
          once ? std::make_unique<MeshError>(model_, model_.parameters().theta(question.w), BasisOptions(), relatives_)
               : std::make_unique<MeshError>(model_);
    }
    std::optional<MeshError::Answer>& mesh = job_.answers.mesh;
    if (subjects.mesh) mesh = job_.mesh_error->study(question);
    if (subjects.inputs && mesh) question.mesh_changes = job_.mesh_error->changes(question, mesh->shift);
    job_.failure.clear();
  } catch (const std::exception& error) {
    job_.failure = error.what();
  }
  if (once) job_.mesh_error.reset();
}

void Studies::study_inputs(const Question& question) {
  try {
    if (!job_.input_study) job_.input_study = std::make_unique<InputStudy>(model_);
    job_.answers.inputs = job_.input_study->study(question);
  } catch (const std::exception&) {
    // The last answer stays; more frames may settle the next.
  }
}

Studies::Answers Studies::take() {
  work_.get();
  failure_ = job_.failure;
  Answers out = job_.answers;
  job_.answers.inputs.reset();
  if (!failure_.empty()) out.mesh.reset();
  mesh_answered_ = mesh_answered_ || out.mesh.has_value();
  return out;
}

// What is under way takes seconds, and a node that starts over has none.
void Studies::give_up() {
  if (!work_.valid()) return;
  given_up_ = true;
  if (work_.wait_for(std::chrono::seconds(0)) != std::future_status::deferred) work_.wait();
  work_ = {};
  given_up_ = false;
}

void Studies::reset() {
  give_up();
  job_.answers = {};
  job_.failure.clear();
  failure_.clear();
  last_mesh_ = last_inputs_ = 0;
  mesh_is_newer_ = mesh_answered_ = false;
}

}  // namespace tissue_stiffness
