#include "check/motion_study.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "check/starts_in_motion.hpp"
#include "effects/registry.hpp"
#include "fit/ensemble.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostFrames = 60;  // that are used, evenly over the recording
constexpr double kWidest = 3.0;          // standard deviations of the prior
constexpr double kGridStep = 0.5;
constexpr int kSections = 10;

bool is_force(const Observation& seen) {
  return traits_of(seen.kind).force;
}

// Forces are no motion.
std::vector<Frame> without_forces(std::vector<Frame> frames) {
  for (Frame& frame : frames) {
    auto& seen = frame.observations;
    seen.erase(std::remove_if(seen.begin(), seen.end(), is_force), seen.end());
  }
  frames.erase(std::remove_if(frames.begin(), frames.end(), [](const Frame& f) { return f.observations.empty(); }),
               frames.end());
  return frames;
}

std::vector<Frame> thinned(const std::vector<Frame>& frames) {
  const auto named = [](const Observation& seen) { return seen.ids.size() > 0; };
  const bool quick = std::all_of(frames.begin(), frames.end(), [&](const Frame& frame) {
    return std::all_of(frame.observations.begin(), frame.observations.end(), named);
  });
  const std::size_t most = quick ? kMostFrames : MotionStudy::most_outlines;
  const std::size_t stride = (frames.size() + most - 1) / most;
  std::vector<Frame> out;
  for (std::size_t i = 0; i < frames.size(); i += std::max<std::size_t>(stride, 1)) out.push_back(frames[i]);
  return out;
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

bool MotionStudy::applies(const ModelSettings& settings) {
  return settings.initial.kind != InitialSettings::Kind::from_frames && !starts_in_motion(settings) &&
         std::any_of(settings.observations.begin(), settings.observations.end(),
                     [](const ObservationSettings& sensor) { return !traits_of(sensor.kind).force; }) &&
         std::none_of(settings.effects.begin(), settings.effects.end(),
                      [](const EffectSettings& effect) { return effect_spec(effect).contact; });
}

MotionStudy::MotionStudy(const ModelSettings& settings, const TetMesh& mesh, const Recorded& recorded)
    : model_(settings, mesh),
      operators_(make_observation_operators(model_)),
      shown_(thinned(without_forces(recorded.frames))) {
  model_.loads().drive(recorded.first_stamp, recorded.loads);
  forward_ = make_forward_model(model_, BasisOptions().linear_form());
  start_ = recorded.first_stamp + settings.time.start;
  std::vector<double> all;
  for (std::size_t k = 0; k < shown_.size(); ++k) {
    const Prediction rest = predict_frame(model_, operators_, shown_[k],
                                          model_.parameters().theta(model_.parameters().prior_mean()), model_.rest());
    at_rest_.push_back(rest.predicted);
    for (Eigen::Index i = 0; i < rest.measured.size(); ++i) {
      const double moved = rest.measured[i] - rest.predicted[i];
      all.push_back(std::isfinite(moved) ? moved : 0.0);
      frame_of_.push_back(static_cast<int>(k));
    }
    for (const Observation& seen : shown_[k].observations) {
      sources_.insert(sources_.end(), static_cast<std::size_t>(seen.row_count()), seen.source);
    }
  }
  sources_.resize(all.size(), sources_.empty() ? 0 : sources_.back());
  measured_ = Eigen::Map<const Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
  for (std::size_t i = 0; i < model_.parts().size(); ++i) {
    const auto& terms = model_.parts()[i].terms.loads;
    if (std::any_of(terms.begin(), terms.end(), [](const LoadTerm& term) { return term.course && !term.prescribed; })) {
      loads_.push_back(i);
    }
  }
  moduli_ = model_.parameters().prior_std();
  for (Eigen::Index i = 0; i < moduli_.size(); ++i) {
    if (!ends_with(model_.parameters().free()[static_cast<std::size_t>(i)].name, ".young_modulus")) moduli_[i] = 0.0;
  }
}

Eigen::VectorXd MotionStudy::predicted(double z, std::ptrdiff_t without) const {
  Eigen::VectorXd theta = model_.parameters().theta(model_.parameters().prior_mean() + z * moduli_);
  // A load's first parameter is its scale factor.
  if (without >= 0) theta[model_.parts()[static_cast<std::size_t>(without)].indices.front()] = 0.0;
  const auto run = forward_->start(theta, start_);
  Eigen::VectorXd out = Eigen::VectorXd::Zero(measured_.size());
  Eigen::Index at = 0;
  for (std::size_t k = 0; k < shown_.size(); ++k) {
    run->advance(shown_[k].time - model_.sensors().delay(theta));
    const Prediction there = predict_frame(model_, operators_, shown_[k], theta, run->output());
    const Eigen::VectorXd moved = there.predicted - at_rest_[k];
    for (Eigen::Index i = 0; i < moved.size(); ++i, ++at) out[at] = std::isfinite(moved[i]) ? moved[i] : 0.0;
  }
  return out;
}

double MotionStudy::best_modulus() const {
  if (!best_) best_ = modulus_is_free() ? search() : 0.0;
  return *best_;
}

double MotionStudy::search() const {
  const auto error = [&](double z) { return (measured_ - predicted(z)).squaredNorm(); };
  double best = 0.0, least = error(0.0);
  for (double z = -kWidest; z <= kWidest; z += kGridStep) {
    const double now = error(z);
    if (now < least) best = z, least = now;
  }
  const double golden = 0.5 * (std::sqrt(5.0) - 1.0);
  double lower = best - kGridStep, upper = best + kGridStep;
  double a = upper - golden * (upper - lower), b = lower + golden * (upper - lower);
  double at_a = error(a), at_b = error(b);
  for (int i = 0; i < kSections; ++i) {
    if (at_a < at_b) {
      upper = std::exchange(b, a), at_b = at_a;
      at_a = error(a = upper - golden * (upper - lower));
    } else {
      lower = std::exchange(a, b), at_a = at_b;
      at_b = error(b = lower + golden * (upper - lower));
    }
  }
  return 0.5 * (lower + upper);
}

}  // namespace tissue_stiffness
