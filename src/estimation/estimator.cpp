#include "tissue_stiffness/estimation/estimator.hpp"

#include "estimation/identify.hpp"
#include "estimation/scheme.hpp"

namespace tissue_stiffness {

class Estimator::Implementation {
 public:
  explicit Implementation(std::unique_ptr<Scheme> s) : scheme(std::move(s)) {}
  std::unique_ptr<Scheme> scheme;
};

Estimator::Estimator(const ModelSettings& settings, const TetMesh& mesh) : Estimator(settings, mesh, {}) {}

Estimator::Estimator(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives)
    : implementation_(std::make_unique<Implementation>(settings.estimator == EstimatorKind::paper
                                                           ? make_paper_scheme(settings, mesh)
                                                           : make_unscented_scheme(settings, mesh, relatives))) {}
Estimator::~Estimator() = default;
Estimator::Estimator(Estimator&&) noexcept = default;

const std::vector<LoadInput>& Estimator::load_inputs() const {
  return implementation_->scheme->model().loads().inputs();
}
void Estimator::set_first_stamp(double time) {
  implementation_->scheme->set_first_stamp(time);
}
void Estimator::work_in_background() {
  implementation_->scheme->work_in_background();
}
void Estimator::add_load(const LoadSample& sample) {
  implementation_->scheme->add_load(sample);
}
StepResult Estimator::step(const Frame& frame) {
  return implementation_->scheme->step(frame);
}
StepResult Estimator::replay(const std::vector<Frame>& frames, const Estimate* near,
                             const std::function<void()>& checkpoint) {
  return implementation_->scheme->replay(frames, near, checkpoint);
}
std::optional<StepResult> Estimator::catch_up() {
  return implementation_->scheme->catch_up();
}
bool Estimator::reprocesses() const {
  return implementation_->scheme->reprocesses();
}
void Estimator::reset() {
  implementation_->scheme->reset();
}
const TetMesh& Estimator::mesh() const {
  return implementation_->scheme->model().mesh();
}
const Estimate& Estimator::estimate() const {
  return implementation_->scheme->estimate();
}
const Eigen::Matrix3Xd& Estimator::displacement() const {
  return implementation_->scheme->displacement();
}
const Prediction& Estimator::prediction() const {
  return implementation_->scheme->prediction();
}
std::optional<double> Estimator::basis_error() const {
  return implementation_->scheme->basis_error();
}
std::vector<std::string> Estimator::description() const {
  return implementation_->scheme->description();
}
std::vector<Misfit> Estimator::free_run(const FreeFrameVisitor& visit) {
  return implementation_->scheme->free_run(visit);
}

std::map<std::string, Identifiability> Estimator::identifiability() const {
  return identify(implementation_->scheme->model(), implementation_->scheme->parameter_covariance());
}

}  // namespace tissue_stiffness
