#include "estimation/observed_body.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

#include "estimation/posterior.hpp"
#include "fit/ensemble.hpp"
#include "forward/reduced_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kManyNodes = 10000;  // nodes beyond which every vector of the basis delays the first estimate noticeably
constexpr int kFewVectors = 24;    // vectors to start with there; the basis grows when that is not enough

}  // namespace

ObservedBody::ObservedBody(const ModelSettings& settings, const TetMesh& mesh, const ReuseSources& relatives)
    : model_(relatives.own != nullptr ? std::make_unique<Model>(settings, relatives.own->model())
                                      : std::make_unique<Model>(settings, mesh)),
      operators_(make_observation_operators(*model_)) {
  if (model_->parameters().free().empty()) {
    throw InputError(settings.name + ": effects", "only known numbers", "at least one {prior, factor} or {mean, std}");
  }
  if (operators_.empty()) throw InputError(settings.name + ": observations", "an empty list", "at least one entry");
  limits_.stale_after = settings.stale_after;
  BasisOptions basis;
  if (mesh.node_count() > kManyNodes) basis.size = kFewVectors;
  basis.keep_root = relatives.own != nullptr;
  forward_ = make_forward_model(*model_, basis, relatives.own);
}

void ObservedBody::set_first_stamp(double time) {
  first_stamp_ = time;
  model_->loads().set_first_stamp(time);
}

void ObservedBody::guess_first_stamp(double time) {
  if (!first_stamp_) set_first_stamp(std::min(time, first_load_));
}

void ObservedBody::add_load(const LoadSample& sample) {
  const auto course = model_->loads().courses().find(sample.topic);
  if (course == model_->loads().courses().end()) return;
  if (!sample.value.allFinite() || sample.value.size() != course->second->components()) {
    throw InputError(sample.topic, "a load that is not finite or has the wrong size",
                     std::to_string(course->second->components()) + " finite number(s)");
  }
  if (!std::isfinite(sample.time)) throw InputError(sample.topic, "a load without a time", "a finite time [s]");
  course->second->add(sample.time, sample.value);
  first_load_ = std::min(first_load_, sample.time);
}

std::string ObservedBody::stale_load(double time) const {
  for (const LoadInput& input : model_->loads().inputs()) {
    const std::optional<double> last = model_->loads().courses().at(input.topic)->last();
    const double since = time - last.value_or(start());
    if (since <= limits_.stale_after) continue;
    std::ostringstream text;
    text << "no load has come on " << input.topic << (last ? " for " : " in ") << std::setprecision(3) << since << " s";
    return text.str();
  }
  return "";
}

void ObservedBody::forget() {
  first_stamp_.reset();
  first_load_ = std::numeric_limits<double>::infinity();
  model_->parameters().forget_velocity_prior();
  for (auto& course : model_->loads().courses()) course.second->clear();
}

Estimate ObservedBody::prior_estimate() const {
  const ParameterSpace& parameters = model_->parameters();
  const Eigen::VectorXd std = parameters.prior_std();
  return summarise_posterior(parameters.free(), parameters.prior_mean(), std.cwiseAbs2().asDiagonal());
}

Prediction ObservedBody::at_rest(const Frame& frame) const {
  return predict_at_rest(*model_, operators_, frame);
}

bool ObservedBody::sees(const Frame& frame) const {
  bool any = false;
  for (const Observation& observation : frame.observations) {
    const auto source = static_cast<std::size_t>(observation.source);
    if (source >= operators_.size()) {
      throw InputError("observations", "entry " + std::to_string(observation.source),
                       "0 to " + std::to_string(operators_.size() - 1));
    }
    operators_[source]->check(observation);
    any = observation.holds_anything() || any;
  }
  return any;
}

bool ObservedBody::note_nodes_of(const Frame& frame) {
  bool more = false;
  if (seen_nodes_.empty()) seen_nodes_.assign(static_cast<std::size_t>(model_->mesh().node_count()), 0);
  for (const Observation& observation : frame.observations) {
    for (const int node : operators_[static_cast<std::size_t>(observation.source)]->nodes(observation)) {
      char& seen = seen_nodes_[static_cast<std::size_t>(node)];
      more = more || seen == 0;
      seen = 1;
    }
  }
  return more;
}

void ObservedBody::extend_output() {
  std::vector<int> nodes;
  for (std::size_t node = 0; node < seen_nodes_.size(); ++node) {
    if (seen_nodes_[node] != 0) nodes.push_back(static_cast<int>(node));
  }
  forward_->restrict_output_to(nodes);
}

std::vector<Misfit> ObservedBody::compare_free_run(const std::vector<Frame>& frames, const RunStart& start,
                                                   const Eigen::VectorXd& theta, const FreeFrameVisitor& visit,
                                                   const std::vector<ParameterChange>& changes) {
  forward_->restrict_output_to({});
  auto misfits = free_run({*model_, *forward_, operators_, frames, start}, theta, visit, changes);
  seen_nodes_.clear();  // the next frame restricts the output again
  return misfits;
}

}  // namespace tissue_stiffness
