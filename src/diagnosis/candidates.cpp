#include "diagnosis/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>

#include "effects/registry.hpp"
#include "fit/nested_parameters.hpp"
#include "forward/extra_force.hpp"
#include "forward/for_each_index.hpp"
#include "forward/linearised_model.hpp"
#include "settings/extend_model.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kProbe = 0.02;  // of a prior's standard deviation: amplitude at which tangents are read
constexpr double kFar = 0.05;    // of the motion: a larger change is not linear
constexpr double kNear = 0.01;   // of the motion: the change that is tried instead
constexpr int kMostProbes = 4;

ProposalContext context_of(const RecordingFit& base, const Eigen::VectorXd& w) {
  const Model& model = base.model();
  double modulus = 0.0, ratio = 0.0, density = 0.0;
  const Eigen::VectorXd theta = model.parameters().theta(w);
  for (const auto& part : model.parts()) {
    const Eigen::VectorXd values = part.parameters(theta);
    if (part.label == "elasticity") modulus = values[0], ratio = values[1];
    if (part.label == "inertia") density = values[0];
  }
  const std::vector<Frame>& frames = base.recording().frames;
  const double duration = frames.back().time - base.recording().first_stamp;
  return {model.settings(),
          model.mesh(),
          model.body().regions,
          modulus,
          ratio,
          density,
          duration / static_cast<double>(frames.size()),
          duration};
}

// Returns whether a model file may hold the proposal. Its scale follows from the model's own numbers, which may be absurd.
bool can_be_written(const Proposal& proposal) {
  try {
    read_parameters(to_settings(proposal.entry));
    read_parameters(to_settings(proposal.refine));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

Eigen::VectorXd difference(const Eigen::VectorXd& changed, const RecordingRows& base, double amplitude) {
  return base.used.cwiseProduct(changed - base.predicted) / amplitude;
}

// Returns how far the rows go from those of the first frame, rms over all [sigma].
double motion(const RecordingRows& rows) {
  return motion_of(rows).norm() / std::sqrt(static_cast<double>(rows.predicted.size()));
}

// Returns nothing where the run diverges, which one of a linear model does not.
std::optional<Eigen::VectorXd> prediction(const RecordingFit& recording_fit, const Eigen::VectorXd& w) {
  if (!recording_fit.model().nonlinear()) return recording_fit.predicted(w);
  try {
    return recording_fit.predicted(w);
  } catch (const NumericalError&) {
    return std::nullopt;
  }
}

// Returns d rows / d w_j. A slender body answers to what leaves a stout one alone. So the step is cut until the answer is
// small compared with `moves`, the motion of `rest`.
Eigen::VectorXd tangent(const RecordingFit& recording_fit, const RecordingRows& rest, double moves,
                        const Eigen::VectorXd& start, Eigen::Index j) {
  double amplitude = kProbe * recording_fit.model().parameters().prior_std()[j];
  for (int probe = 1;; ++probe) {
    Eigen::VectorXd moved = start;
    moved[j] += amplitude;
    Eigen::VectorXd column = difference(recording_fit.predicted(moved), rest, amplitude);
    const double change = amplitude * column.norm() / std::sqrt(static_cast<double>(column.size()));
    if (!(change > kFar * moves) || moves == 0.0 || probe == kMostProbes) return column;
    amplitude *= kNear * moves / change;
  }
}

// Returns the free parameters that the model has beyond the base's, in order.
std::vector<Eigen::Index> added_parameters(const RecordingFit& recording_fit, const RecordingFit& base) {
  std::vector<Eigen::Index> added;
  for (std::size_t i = 0; i < recording_fit.model().parameters().free().size(); ++i) {
    if (base.index(recording_fit.model().parameters().free()[i].name) < 0) added.push_back(static_cast<Eigen::Index>(i));
  }
  return added;
}

// Reads the tangents of the added parameters of one recording fit; each candidate in turn has `components` columns.
void read_added_tangents(const RecordingFit& recording_fit, const RecordingFit& base, const Eigen::VectorXd& w,
                         const std::vector<Candidate*>& candidates, const std::function<void(double)>& over) {
  const Eigen::VectorXd start = NestedParameters(recording_fit, base).extend(w);
  const RecordingRows rest = recording_fit.rows(start);
  const double moves = motion(rest);
  const std::vector<Eigen::Index> added = added_parameters(recording_fit, base);
  Eigen::MatrixXd columns(rest.error.size(), static_cast<Eigen::Index>(added.size()));
  for_each_index(added.size(), [&](std::size_t j) {
    columns.col(static_cast<Eigen::Index>(j)) = tangent(recording_fit, rest, moves, start, added[j]);
    over(static_cast<double>(candidates.size()) / static_cast<double>(added.size()));
  });
  Eigen::Index at = 0;
  const Eigen::Index each = static_cast<Eigen::Index>(added.size() / candidates.size());
  std::vector<Eigen::Index> counts;
  for (const Candidate* candidate : candidates) {
    const EffectSpec& spec = effect_spec({candidate->effect, candidate->effect, {}});
    Eigen::Index components = each;
    for (const ParameterSpec& parameter : spec.parameters) {
      if (parameter.name == candidate->proposal.amplitude) components = parameter.components;
    }
    counts.push_back(components);
  }
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    candidates[c]->parameter = added[static_cast<std::size_t>(at)];
    Tangent& tangent = candidates[c]->tangent;
    tangent.columns = columns.middleCols(at, counts[c]);
    tangent.prior_std.resize(counts[c]);
    for (Eigen::Index i = 0; i < counts[c]; ++i) {
      tangent.prior_std[i] = recording_fit.model().parameters().prior_std()[added[static_cast<std::size_t>(at + i)]];
    }
    at += counts[c];
  }
}

/// What a candidate's tangent is read from.
enum class Reading { linear_form, first_order, about_run };

// Returns how the tangents of each effect among the candidates are read, by one model of them all.
std::map<std::string, Reading> readings(const RecordingFit& base, const std::vector<Candidate>& candidates) {
  ModelSettings settings = base.model().settings();
  const std::size_t before = settings.effects.size();
  std::vector<std::string> names;
  for (const Candidate& candidate : candidates) {
    if (!names.empty() && names.back() == candidate.effect) continue;
    names.push_back(candidate.effect);
    add_effect(settings, candidate.proposal.entry);
  }
  const Model model(settings, base.model());
  const bool about_run = base.may_be_linearised();
  std::map<std::string, Reading> out;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Model::Part& part = model.parts()[before + i];
    const Reading of_rest = adds_extra_force(part) ? Reading::first_order : Reading::linear_form;
    out[names[i]] = about_run && why_not_linearised(part).empty() ? Reading::about_run : of_rest;
  }
  return out;
}

}  // namespace

bool Candidate::allows(const Eigen::VectorXd& amplitude) const {
  return amplitude.size() == 0 || (amplitude.minCoeff() >= lower && amplitude.maxCoeff() <= upper);
}

std::vector<Candidate> propose_candidates(const RecordingFit& base, const Eigen::VectorXd& w,
                                          const std::vector<std::string>& ignore) {
  const ProposalContext context = context_of(base, w);
  std::vector<Candidate> all;
  for (const EffectSpec& spec : effect_specs()) {
    if (!spec.proposals || std::find(ignore.begin(), ignore.end(), spec.name) != ignore.end()) continue;
    for (Proposal& proposal : spec.proposals(context)) {
      if (!can_be_written(proposal)) continue;
      all.push_back({spec.name, std::move(proposal), {}});
      for (const ParameterSpec& parameter : spec.parameters) {
        if (parameter.name != all.back().proposal.amplitude) continue;
        all.back().absent = parameter.absent;
        all.back().lower = parameter.lower - parameter.absent;
        all.back().upper = 2.0 * (parameter.upper - parameter.absent);  // a tangent may overshoot
      }
    }
  }
  return all;
}

void read_tangents(const RecordingFit& base, const Eigen::VectorXd& w, std::vector<Candidate>& all,
                   const CountProgress& progress, Library& library) {
  const std::map<std::string, Reading> how = readings(base, all);
  const auto are_read = [&](Reading wanted) {
    std::vector<std::size_t> members;
    for (std::size_t c = 0; c < all.size(); ++c) {
      if (how.at(all[c].effect) == wanted) members.push_back(c);
    }
    return members;
  };
  for (Candidate& candidate : all) {
    candidate.linear = !base.may_be_linearised() && how.at(candidate.effect) == Reading::linear_form;
  }
  std::mutex telling;
  double done = 0.0;
  const auto over = [&](double candidates) {
    const std::lock_guard<std::mutex> lock(telling);
    done += candidates;
    progress(static_cast<std::size_t>(done + 1e-6), all.size());
  };
  const auto with = [&](const std::vector<std::size_t>& members, std::vector<Candidate*>& candidates) {
    ModelSettings settings = base.model().settings();
    for (const std::size_t c : members) {
      add_effect(settings, all[c].proposal.entry);
      candidates.push_back(&all[c]);
    }
    return settings;
  };
  const auto read = [&](const std::vector<std::size_t>& members, int per_part, BasisOptions::Nonlinear nonlinear,
                        std::shared_ptr<const RecordingFit>& recording_fit) {
    if (members.empty()) return;
    std::vector<Candidate*> candidates;
    const ModelSettings settings = with(members, candidates);
    BasisOptions options;
    options.per_part = per_part;
    options.nonlinear = nonlinear;
    options.adopt = recording_fit != nullptr;
    recording_fit = std::make_shared<const RecordingFit>(settings, recording_fit ? *recording_fit : base, options);
    read_added_tangents(*recording_fit, base, w, candidates, over);
  };
  const auto read_about_run = [&](const std::vector<std::size_t>& members) {
    if (members.empty()) return;
    std::vector<Candidate*> candidates;
    const std::shared_ptr<const RecordingFit> linearised = base.linearised(with(members, candidates), w);
    read_added_tangents(*linearised, base, w, candidates, over);
    for (Candidate* candidate : candidates) candidate->linearised = linearised;
  };
  run_side_by_side([&] { read(are_read(Reading::linear_form), 4, BasisOptions::Nonlinear::left_out, library.linear); },
                   [&] { read(are_read(Reading::first_order), 16, BasisOptions::Nonlinear::first_order, library.others); },
                   [&] { read_about_run(are_read(Reading::about_run)); });
}

std::unique_ptr<RecordingFit> with_time_steps(const RecordingFit& recording_fit, const Eigen::VectorXd& w) {
  const ProposalContext context = context_of(recording_fit, w);
  std::vector<EffectEntry> entries;
  for (const EffectSpec& spec : effect_specs()) {
    if (!spec.of_simulation) continue;
    for (const Proposal& proposal : spec.proposals(context)) entries.push_back(proposal.entry);
  }
  if (entries.empty()) return nullptr;
  BasisOptions basis;
  basis.adopt = !recording_fit.model().nonlinear();
  return std::make_unique<RecordingFit>(extend_model(recording_fit.model().settings(), entries), recording_fit, basis);
}

Eigen::MatrixXd tangents_of_time_steps(const RecordingFit& recording_fit, const Eigen::VectorXd& w,
                                       const RecordingRows& rows) {
  const std::unique_ptr<RecordingFit> stepped = with_time_steps(recording_fit, w);
  if (!stepped) return Eigen::MatrixXd(rows.error.size(), 0);
  RecordingFit& extended = *stepped;
  extended.borrow(recording_fit);
  const Eigen::VectorXd start = NestedParameters(extended, recording_fit).extend(w),
                        std = extended.model().parameters().prior_std();
  const std::vector<Eigen::Index> added = added_parameters(extended, recording_fit);
  const std::optional<Eigen::VectorXd> predicted = prediction(extended, start);
  if (!predicted) return Eigen::MatrixXd(rows.error.size(), 0);
  RecordingRows rest = rows;
  rest.predicted = *predicted;
  const double moves = motion(rest);
  Eigen::MatrixXd out(rows.error.size(), static_cast<Eigen::Index>(added.size()));
  for (std::size_t j = 0; j < added.size(); ++j) {
    out.col(static_cast<Eigen::Index>(j)) = std[added[j]] * tangent(extended, rest, moves, start, added[j]);
  }
  return out;
}

Eigen::MatrixXd base_tangents(const RecordingFit& base, const Eigen::VectorXd& w, const Eigen::VectorXd& std,
                              const RecordingRows& rows) {
  Eigen::MatrixXd out(rows.error.size(), w.size());
  for_each_index(static_cast<std::size_t>(w.size()), [&](std::size_t k) {
    const auto i = static_cast<Eigen::Index>(k);
    const Eigen::VectorXd step = std::max(0.5 * std[i], 1e-6) * Eigen::VectorXd::Unit(w.size(), i);
    const std::optional<Eigen::VectorXd> up = prediction(base, w + step), down = prediction(base, w - step);
    const Eigen::VectorXd middle = up && down ? Eigen::VectorXd() : base.predicted(w);  // throws where nothing runs
    const double width = (up ? step[i] : 0.0) + (down ? step[i] : 0.0);
    out.col(i) = rows.used.cwiseProduct((up ? *up : middle) - (down ? *down : middle)) / std::max(width, step[i]);
  });
  return out;
}

}  // namespace tissue_stiffness
