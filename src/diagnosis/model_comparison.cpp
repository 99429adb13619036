#include "tissue_stiffness/diagnosis/model_comparison.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue_stiffness/diagnosis/candidates.hpp"
#include "tissue_stiffness/diagnosis/missing_force.hpp"
#include "tissue_stiffness/diagnosis/scores.hpp"
#include "tissue_stiffness/forward/reduced_trajectory.hpp"
#include "tissue_stiffness/settings/extend_model.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSteps[] = {1.0, 4.0};  // squared steps that are tried, over their prior's standard deviation
constexpr double kNarrower = 0.25;       // ratio of the widths of successive priors in the mixture
constexpr double kTiny = 1e-12;          // [sigma^2]: a direction that no row sees
constexpr double kSpread = 0.05;         // prior standard deviations, of the fit that starts where the linearisation leads

double log_determinant(const Eigen::LDLT<Eigen::MatrixXd>& factor) {
  return factor.vectorD().array().max(std::numeric_limits<double>::min()).log().sum();
}

Eigen::MatrixXd lowest_modes(const FittedModel& fitted) {
  const RecordingFit& recording_fit = *fitted.recording_fit;
  const auto reduced = recording_fit.reduced();
  const double start = recording_fit.recording().first_stamp + recording_fit.model().settings().time.start;
  const ReducedTrajectory at_rest(*reduced, recording_fit.model().theta(fitted.fit.w), start);
  const Eigen::Index count = std::min<Eigen::Index>(kComparison.test_modes, at_rest.frequencies().size());
  return recording_fit.rows_along(fitted.fit.w, at_rest.mode_shapes(static_cast<int>(count)), fitted.rows);
}

// Divides the change of every frame into its shares along the lowest modes and the rest, one column each.
Eigen::MatrixXd parted(const Eigen::VectorXd& change, const Eigen::MatrixXd& along,
                       const std::vector<Eigen::Index>& offsets) {
  const Eigen::Index modes = std::min<Eigen::Index>(kComparison.mesh_modes, along.cols());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(change.size(), modes + 1);
  for (std::size_t k = 0; k + 1 < offsets.size(); ++k) {
    const Eigen::Index from = offsets[k], size = offsets[k + 1] - from;
    if (size == 0) continue;
    const Eigen::MatrixXd lowest = along.block(from, 0, size, modes);
    const Eigen::VectorXd own = change.segment(from, size), share = lowest.colPivHouseholderQr().solve(own);
    out.block(from, 0, size, modes) = lowest * share.asDiagonal();
    out.block(from, modes, size, 1) = own - lowest * share;
  }
  return out;
}

// Returns the sum of squares of what such parts have along the modes.
double along_modes(const Eigen::MatrixXd& parts) {
  return parts.cols() > 0 ? parts.leftCols(parts.cols() - 1).rowwise().sum().squaredNorm() : 0.0;
}

// Returns the most probable unknowns of a linear model and its deviance there, with the noise as stated.
Eigen::VectorXd most_probable(const Linearisation& model, const Eigen::VectorXd& error, Eigen::Index unknowns,
                              double& deviance) {
  const auto j = model.columns.leftCols(unknowns);
  const Eigen::VectorXd mean = model.prior.head(unknowns);
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(unknowns, unknowns) + j.transpose() * j;
  Eigen::VectorXd u = precision.ldlt().solve(j.transpose() * error + mean);
  deviance = (error - j * u).squaredNorm() + (u - mean).squaredNorm();
  return u;
}

void find_probabilities_of(std::vector<Hypothesis>& hypotheses) {
  double most = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (const Hypothesis& h : hypotheses) most = std::max(most, h.log_weight);
  for (Hypothesis& h : hypotheses) sum += h.probability = std::exp(h.log_weight - most);
  for (Hypothesis& h : hypotheses) h.probability /= sum;
}

// Returns the widths of the amplitudes' priors over the stated width.
std::vector<double> scales_of(const Linearisation& model) {
  std::vector<double> out;
  double scale = 1.0;
  do {
    out.push_back(scale);
    scale *= kNarrower;
  } while (!model.amplitudes.empty() && scale >= kComparison.smallest);
  return out;
}

}  // namespace

double log_root_weights(const RecordingFit::Rows& rows) {
  return (rows.used.array() > 0.0).select(rows.used.array().log(), 0.0).sum();
}

std::vector<std::string> added_amplitudes(const RecordingFit& recording_fit, const RecordingFit& smaller) {
  std::vector<std::string> out;
  for (const FreeParameter& p : recording_fit.model().free_parameters()) {
    if (p.prior.kind == Quantity::Kind::normal && smaller.index(p.name) < 0) out.push_back(p.name);
  }
  return out;
}

Linearisation linearise_model(const FittedModel& fitted, const std::vector<std::string>& amplitudes) {
  const RecordingFit& recording_fit = *fitted.recording_fit;
  const Model& model = recording_fit.model();
  const Eigen::VectorXd& w = fitted.fit.w;
  const Eigen::VectorXd prior = model.prior_std();
  // Each tangent is read as far as its parameter is known while the others are held: no tangent reaches far along what they
  // can compensate.
  const Eigen::VectorXd known = fitted.fit.covariance.inverse().diagonal().cwiseInverse().cwiseSqrt();
  const Eigen::MatrixXd own = base_tangents(recording_fit, w, known, fitted.rows);
  const Eigen::MatrixXd steps = tangents_of_time_steps(recording_fit, w, fitted.rows);
  Linearisation out;
  out.columns.resize(own.rows(), own.cols() + steps.cols());
  out.columns << own * prior.asDiagonal(), steps;
  out.prior = Eigen::VectorXd::Zero(out.columns.cols());
  out.prior.head(w.size()) = (model.prior_mean() - w).cwiseQuotient(prior);
  out.parameters = w.size();
  for (const std::string& name : amplitudes) out.amplitudes.push_back(recording_fit.index(name));
  out.log_root_weights = log_root_weights(fitted.rows);
  return out;
}

Explained compared_residual(const FittedModel& fitted, const std::vector<std::string>& amplitudes, bool far) {
  Explained out{fitted.rows.error, linearise_model(fitted, amplitudes)};
  const RecordingFit& recording_fit = *fitted.recording_fit;
  const Eigen::Index all = out.linearisation.columns.cols(), own = out.linearisation.parameters;
  if (recording_fit.model().nonlinear() || all == own) return out;
  double with = 0.0, without = 0.0;
  most_probable(out.linearisation, out.error, own, without);
  const Eigen::VectorXd u = most_probable(out.linearisation, out.error, all, with);
  const bool linear = without - with > 2.0 * kComparison.worthwhile && u[own] > 0.0;
  if (!linear && !far) return out;
  FittedModel joint;
  joint.recording_fit = std::make_unique<RecordingFit>(
      extend_model(recording_fit.model().settings(), entries_of_time_steps(recording_fit, fitted.fit.w)), recording_fit);
  const RecordingFit& stepped_study = *joint.recording_fit;
  const Eigen::VectorXd at = stepped_study.extend(recording_fit, fitted.fit.w), prior = stepped_study.model().prior_std();
  const Eigen::VectorXd near = kSpread * prior;
  if (linear) joint.fit = stepped_study.quick_fit(at + prior.cwiseProduct(u), near);
  // Long steps lead a body that rings into another minimum, which no tangent shows.
  const std::vector<Eigen::Index> tuning = stepped_study.tuning_shared_with(recording_fit);
  for (const double length : kSteps) {
    if (!far) break;
    Eigen::VectorXd start = at;
    start.tail(all - own) = length * prior.tail(all - own);
    const BatchFit fit =
        stepped_study.quick_fit(stepped_study.scan_near(start, tuning).w, stepped_study.spread_beyond(recording_fit));
    if (joint.fit.w.size() == 0 || fit.cost < joint.fit.cost) joint.fit = fit;
  }
  joint.rows = stepped_study.rows(joint.fit.w);
  if (joint.rows.error.squaredNorm() > out.error.squaredNorm()) return out;
  return {joint.rows.error, linearise_model(joint, amplitudes)};
}

ModelComparison::ModelComparison(const FittedModel& base, const Eigen::VectorXd& mesh_change)
    : used_((base.rows.used.array() > 0.0).cast<double>()), offsets_(base.rows.offsets), along_(lowest_modes(base)) {
  allow_for_mesh(mesh_change);
  note(base.rows.error);
}

void ModelComparison::allow_for_mesh(const Eigen::VectorXd& change) {
  mesh_ = parted(kComparison.whole_mesh * change, along_, offsets_);
  const Eigen::Index modes = mesh_.cols() - 1, frames = static_cast<Eigen::Index>(offsets_.size()) - 1;
  // The amplitudes are independent from frame to frame and have the mean square of that part of D.
  constexpr double part = kComparison.left_of_mesh / kComparison.whole_mesh;
  const Eigen::VectorXd size = along_.leftCols(modes).colwise().squaredNorm().transpose();
  const Eigen::VectorXd std =
      (part * mesh_.leftCols(modes).colwise().norm().transpose()).cwiseQuotient(size.cwiseSqrt().cwiseMax(kTiny));
  basis_ = Eigen::MatrixXd::Zero(along_.rows(), modes);
  variances_ = Eigen::MatrixXd::Zero(modes, frames);
  for (Eigen::Index k = 0; k < frames; ++k) {
    const Eigen::Index from = offsets_[static_cast<std::size_t>(k)],
                       rows = offsets_[static_cast<std::size_t>(k) + 1] - from;
    const Eigen::MatrixXd root = along_.block(from, 0, rows, modes) * std.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.transpose() * root);
    for (Eigen::Index i = 0; i < modes; ++i) {
      const double variance = eigen.eigenvalues()[i];
      if (!(variance > kTiny)) continue;
      basis_.block(from, i, rows, 1) = root * eigen.eigenvectors().col(i) / std::sqrt(variance);
      variances_(i, k) = variance;
    }
  }
}

Eigen::MatrixXd ModelComparison::whitened(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd out = rows;
  const double s = noise_variance_;
  for (std::size_t k = 0; k + 1 < offsets_.size(); ++k) {
    const Eigen::Index from = offsets_[k], size = offsets_[k + 1] - from;
    if (size == 0 || variances_.size() == 0) continue;
    const auto basis = basis_.middleRows(from, size);
    const Eigen::ArrayXd shrink = 1.0 - (s / (s + variances_.col(static_cast<Eigen::Index>(k)).array())).sqrt();
    out.middleRows(from, size) -=
        basis * (shrink.matrix().asDiagonal() * (basis.transpose() * rows.middleRows(from, size)));
  }
  return out;
}

void ModelComparison::note(const Eigen::VectorXd& error) {
  MisfitTest left = test_of(error, 0.0);
  left.set_noise(MisfitTest::most_noise);
  const double memory = left.lag1_autocorrelation(), variance = left.noise_level() * (1.0 + memory) / (1.0 - memory);
  noise_variance_ = noise_variance_ > 0.0 ? std::min(noise_variance_, variance) : variance;
  noise_level_ = std::min(noise_level_, left.noise_level());
}

void ModelComparison::note(const ModelComparison& other) {
  noise_variance_ = std::min(noise_variance_, other.noise_variance_);
  noise_level_ = std::min(noise_level_, other.noise_level_);
}

Assessment ModelComparison::assess(const Explained& explained) const {
  const Linearisation& model = explained.linearisation;
  const double s = noise_variance_;
  Eigen::MatrixXd j(explained.error.size(), model.columns.cols() + mesh_.cols());
  j << model.columns, mesh_;
  const Eigen::MatrixXd white = whitened(j);
  const Eigen::VectorXd error = whitened(explained.error);
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(j.cols());
  mean.head(model.prior.size()) = model.prior;
  const Eigen::MatrixXd gram = white.transpose() * white / s;
  const Eigen::VectorXd seen = white.transpose() * error / s;
  const Eigen::Index own = model.parameters, rest = j.cols() - own;
  Assessment out;
  Eigen::VectorXd u;
  std::vector<double> evidence;
  for (const double scale : scales_of(model)) {
    Eigen::VectorXd weight = Eigen::VectorXd::Ones(j.cols());
    for (const Eigen::Index i : model.amplitudes) weight[i] = 1.0 / (scale * scale);
    Eigen::MatrixXd precision = gram;
    precision.diagonal() += weight;
    const Eigen::LDLT<Eigen::MatrixXd> factor(precision);
    const Eigen::VectorXd pull = seen + weight.cwiseProduct(mean);
    Eigen::VectorXd at = factor.solve(pull);
    // Numerics that are not plausible explain nothing, so the parameters have to do without them.
    at.tail(rest) = at.tail(rest).cwiseMax(-kComparison.most_numerics).cwiseMin(kComparison.most_numerics);
    at.head(own) = precision.topLeftCorner(own, own).ldlt().solve(pull.head(own) -
                                                                  precision.topRightCorner(own, rest) * at.tail(rest));
    const double likelihood = model.log_root_weights - 0.5 * (error - white * at).squaredNorm() / s;
    evidence.push_back(likelihood - 0.5 * (weight.dot((at - mean).cwiseAbs2()) + log_determinant(factor)) +
                       0.5 * weight.array().log().sum());
    if (evidence.back() < *std::max_element(evidence.begin(), evidence.end())) continue;
    u = at;
    out.log_likelihood = likelihood;
  }
  out.log_evidence = log_mean_exp(evidence);
  out.left = explained.error - j * u;
  out.test = test_of(out.left, static_cast<double>(model.columns.cols()));
  constexpr double part = kComparison.left_of_mesh / kComparison.whole_mesh;
  const double across = mesh_.cols() > 0 ? mesh_.rightCols(1).squaredNorm() : 0.0;
  out.test.set_numerics(part * part * along_modes(mesh_) / used_.sum(), part * part * across / used_.sum());
  return out;
}

MisfitTest ModelComparison::test_of(const Eigen::VectorXd& error, double fitted) const {
  MisfitTest out = test_where(error, 0, static_cast<Eigen::Index>(offsets_.size()) - 1, [](Eigen::Index) { return true; });
  out.set_fitted(fitted);
  return out;
}

MisfitTest ModelComparison::test_where(const Eigen::VectorXd& error, Eigen::Index first, Eigen::Index last,
                                       const std::function<bool(Eigen::Index)>& inside) const {
  MisfitTest out;
  out.set_noise(noise_level_);
  for (Eigen::Index k = first; k < last; ++k) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index r = offsets_[static_cast<std::size_t>(k)]; r < offsets_[static_cast<std::size_t>(k) + 1]; ++r) {
      if (inside(r)) rows.push_back(r);
    }
    if (rows.empty()) continue;
    const auto size = static_cast<Eigen::Index>(rows.size());
    const Eigen::Index modes = std::min<Eigen::Index>(along_.cols(), std::max<Eigen::Index>(1, size / 4));
    Eigen::VectorXd residual(size), used(size);
    Eigen::MatrixXd shapes(size, modes);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Index r = rows[static_cast<std::size_t>(i)];
      residual[i] = error[r];
      used[i] = used_[r];
      shapes.row(i) = along_.row(r).head(modes);
    }
    out.add(residual, used, shapes);
  }
  return out;
}

bool Hypothesis::holds(const std::string& effect) const {
  return std::find(effects.begin(), effects.end(), effect) != effects.end();
}

bool Hypothesis::superfluous_beside(const Hypothesis& other) const {
  const bool all = std::all_of(other.effects.begin(), other.effects.end(), [this](const auto& e) { return holds(e); });
  return all && !other.structured && (effects.size() > other.effects.size() || random_force);
}

void Hypothesis::weigh(const Assessment& assessment, const ModelComparison& models) {
  log_weight = assessment.log_evidence + log_prior;
  if (random_force) log_weight += log_evidence_gained(*random_force, assessment, models);
  z = assessment.test.z();
  passes = !random_force && assessment.test.passes();
  structured = random_force || assessment.test.discrepancy() > 0.0;
}

const Hypothesis& Comparison::best() const {
  return *std::max_element(hypotheses.begin(), hypotheses.end(),
                           [](const Hypothesis& a, const Hypothesis& b) { return a.probability < b.probability; });
}

double Comparison::none_of_these() const {
  double sum = 0.0;
  for (const Hypothesis& h : hypotheses) sum += h.random_force ? h.probability : 0.0;
  return sum;
}

double Comparison::probability_of(const std::string& effect) const {
  double sum = 0.0;
  for (const Hypothesis& h : hypotheses) sum += h.holds(effect) && !h.random_force ? h.probability : 0.0;
  return sum;
}

std::vector<Trace> Comparison::traces() const {
  const Hypothesis& plain = best();
  std::vector<Hypothesis> weighed{plain};
  std::vector<Trace> out;
  for (const Hypothesis& h : hypotheses) {
    if (h.random_force || !h.superfluous_beside(plain)) continue;
    out.push_back({&h, 0.0});
    weighed.push_back(h);
  }
  find_probabilities_of(weighed);
  const double sum = 1.0 - weighed.front().probability, together = std::min(sum, 0.5);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].share = sum > 0.0 ? together * weighed[i + 1].probability / sum : 0.0;
  return out;
}

void Comparison::find_probabilities() {
  constexpr double none = -std::numeric_limits<double>::infinity();
  for (Hypothesis& h : hypotheses) {
    const auto enough = [&h](const Hypothesis& other) { return h.superfluous_beside(other); };
    h.superfluous = std::any_of(hypotheses.begin(), hypotheses.end(), enough);
  }
  std::vector<Hypothesis> weighed = hypotheses;
  for (Hypothesis& h : weighed) {
    if (h.superfluous) h.log_weight = none;
  }
  const Hypothesis* best = &weighed.front();
  for (const Hypothesis& h : weighed) {
    if (!h.random_force && h.log_weight > best->log_weight) best = &h;
  }
  const double model = best->log_weight - best->log_prior, more = log_bayes_factor_bound(best->z);
  for (Hypothesis& h : weighed) {
    if (h.random_force && h.log_weight > none && h.effects == best->effects)
      h.log_weight = std::max(h.log_weight, model + h.log_prior + more);
  }
  find_probabilities_of(weighed);
  for (std::size_t i = 0; i < weighed.size(); ++i) hypotheses[i].probability = weighed[i].probability;
}

void Comparison::assess(const ModelComparison& models) {
  tbb::parallel_for(std::size_t{0}, hypotheses.size(), [&](std::size_t i) {
    const Assessment assessment = models.assess(*hypotheses[i].explained);
    hypotheses[i].weigh(assessment, models);
  });
  find_probabilities();
}

void Comparison::merge(const std::vector<std::string>& effects, const Comparison& deeper) {
  const auto same = [&](const Hypothesis& h) { return h.effects == effects; };
  const double prior = std::find_if(hypotheses.begin(), hypotheses.end(), same)->log_prior;
  hypotheses.erase(std::remove_if(hypotheses.begin(), hypotheses.end(), same), hypotheses.end());
  for (Hypothesis h : deeper.hypotheses) {
    h.effects.insert(h.effects.begin(), effects.begin(), effects.end());
    h.log_prior += prior;
    hypotheses.push_back(std::move(h));
  }
}

Verdict judge(const Comparison& c) {
  const Hypothesis& given = c.given();
  if (given.probability > 1.0 - kComparison.believed)
    return given.passes ? (c.passes_without_mesh ? Verdict::adequate : Verdict::numerics) : Verdict::unexplained;
  const Hypothesis& best = c.best();
  return !best.effects.empty() && !best.random_force && best.passes ? Verdict::missing : Verdict::unexplained;
}

std::vector<std::string> believed_effects(const Comparison& comparison) {
  std::vector<Hypothesis> named;
  for (const Hypothesis& h : comparison.hypotheses) {
    if (!h.effects.empty() && !h.superfluous) named.push_back(h);
  }
  find_probabilities_of(named);
  std::stable_sort(named.begin(), named.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.probability > b.probability; });
  std::vector<std::string> out;
  double held = 0.0;
  for (const Hypothesis& h : named) {
    if (held > kComparison.believed) break;
    held += h.probability;
    for (const std::string& effect : h.effects) {
      if (std::find(out.begin(), out.end(), effect) == out.end()) out.push_back(effect);
    }
  }
  return out;
}

}  // namespace tissue_stiffness
