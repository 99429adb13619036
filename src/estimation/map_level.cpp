#include "estimation/map_level.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/basis_error.hpp"
#include "estimation/identify.hpp"
#include "filter/interval.hpp"
#include "fit/batch_fit.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kVectorsAPatch = 4;  // vectors of the reduced basis
constexpr int kMostGrowths = 3;    // growths of the basis, by half each
constexpr double kSpread = 0.05;   // prior standard deviations that the first slopes are read over

double log_determinant(const Eigen::MatrixXd& covariance) {
  return covariance.ldlt().vectorD().array().abs().log().sum();
}

// Replaces the mapped modulus among the base model's parameters by the patches' moduli.
Eigen::VectorXd spread_out(const Eigen::VectorXd& base, Eigen::Index at, const Eigen::VectorXd& log_modulus) {
  Eigen::VectorXd out(base.size() - 1 + log_modulus.size());
  out << base.head(at), log_modulus, base.tail(base.size() - at - 1);
  return out;
}

}  // namespace

MapLevel::MapLevel(const MapQuestion& question, const Model& base, std::vector<Patch> patches, const Eigen::VectorXd& start,
                   const Eigen::VectorXd& log_modulus)
    : question_(question),
      patches_(std::move(patches)),
      centers_(centers(base.mesh(), patches_)),
      patch_model_(with_patches(base, patches_, log_modulus)),
      model_(patch_model_.settings, base.mesh(), patch_model_.regions),
      operators_(make_observation_operators(model_)) {
  model_.loads().drive(question.first_stamp, question.loads);
  const auto count = static_cast<Eigen::Index>(patches_.size());
  const MapSettings& map = *question.settings.map;
  prior_mean_ = model_.parameters().prior_mean();
  prior_mean_.segment(patch_model_.first, count).setConstant(patch_model_.common);
  prior_covariance_ = patch_covariance(patch_model_, model_.parameters().prior_std(),
                                       smooth_covariance(centers_, map.length, std::log(map.factor)));
  basis_.size += kVectorsAPatch * static_cast<int>(count);
  basis_.largest = std::max(basis_.largest, basis_.size);
  fit(spread_out(start, patch_model_.first, log_modulus));
}

// Fits in a basis that grows until it leaves out a small part of the noise.
void MapLevel::fit(const Eigen::VectorXd& start) {
  Eigen::VectorXd at = start;
  const RunStart rest{question_.first_stamp + model_.settings().time.start};
  for (int growth = 0;; ++growth) {
    ReducedModel runs(model_, basis_);
    const std::vector<int> nodes = observed_nodes(operators_, question_.frames);
    runs.restrict_output_to(nodes);
    const FitProblem problem{model_, runs, operators_, question_.frames, rest, question_.checkpoint};
    const PosteriorLinearizationFilter prior(prior_mean_, prior_covariance_);
    filter_ = fit_filter(problem, prior, at, kSpread * prior.spread());
    at = filter_->anchor();
    if (growth == kMostGrowths || basis_error(runs, problem, at, nodes).sigmas <= kBasisShare) return;
    basis_.size += basis_.size / 2;
    basis_.largest = std::max(basis_.largest, basis_.size);
  }
}

Eigen::VectorXd MapLevel::log_modulus() const {
  return filter_->anchor().segment(patch_model_.first, static_cast<Eigen::Index>(patches_.size()));
}

Eigen::VectorXd MapLevel::base_parameters() const {
  const Eigen::VectorXd& w = filter_->anchor();
  const auto count = static_cast<Eigen::Index>(patches_.size());
  Eigen::VectorXd out(w.size() - count + 1);
  out << w.head(patch_model_.first), log_modulus().mean(), w.tail(w.size() - patch_model_.first - count);
  return out;
}

double MapLevel::prior_cost() const {
  const Eigen::VectorXd step = filter_->anchor() - prior_mean_;
  return step.dot(prior_covariance_.ldlt().solve(step));
}

// Returns the log of the posterior's volume over the prior's.
double MapLevel::log_volume() const {
  return 0.5 * (log_determinant(filter_->covariance()) - log_determinant(prior_covariance_));
}

double MapLevel::evidence_over(const MapLevel& coarser) const {
  const double scale = filter_->misfit_scale();
  const auto data_cost = [](const MapLevel& level) {
    return level.filter_->cost() - level.filter_->misfit_scale() * level.prior_cost();
  };
  return 0.5 * ((data_cost(coarser) - data_cost(*this)) / scale + coarser.prior_cost() - prior_cost()) + log_volume() -
         coarser.log_volume();
}

const MapLevel::MeshStudy& MapLevel::mesh_study() {
  if (study_) return *study_;
  study_.emplace();
  study_->why_not = MeshError::why_not(model_);
  if (!study_->why_not.empty()) return *study_;
  question_.checkpoint();
  const MeshError::Question q(model_, question_.frames, filter_->anchor(), filter_->spread(),
                              prior_covariance_.diagonal().cwiseSqrt());
  try {
    study_->answer = MeshError(model_, model_.parameters().theta(q.w), basis_).study(q);
  } catch (const NumericalError& error) {
    study_->why_not = error.what();
  }
  return *study_;
}

Eigen::VectorXd MapLevel::mesh_shift() {
  const auto& answer = mesh_study().answer;
  return answer ? answer->believed(filter_->misfit_scale()) : Eigen::VectorXd::Zero(filter_->anchor().size());
}

double MapLevel::told() const {
  return learnt * std::log(question_.settings.map->factor);
}

std::vector<StiffnessPatch> MapLevel::describe(const Eigen::VectorXd& shift) const {
  const Eigen::VectorXd w = filter_->anchor() - shift;
  const Eigen::MatrixXd covariance = filter_->robust_covariance() + mesh_discrepancy(model_, shift);
  std::vector<StiffnessPatch> out;
  for (Eigen::Index r = 0; r < centers_.cols(); ++r) {
    const Eigen::Index i = patch_model_.first + r;
    const Interval interval = log_normal_interval(w[i], covariance(i, i));
    StiffnessPatch patch;
    patch.center = centers_.col(r);
    patch.young_modulus = std::exp(w[i]);
    patch.std = std::sqrt(covariance(i, i));
    patch.lower95 = interval.lower95;
    patch.upper95 = interval.upper95;
    patch.identified = patch.std < told();
    out.push_back(patch);
  }
  return out;
}

std::vector<bool> MapLevel::seen() const {
  const auto inverse = [](const Eigen::MatrixXd& m) -> Eigen::MatrixXd {
    return m.ldlt().solve(Eigen::MatrixXd::Identity(m.rows(), m.cols()));
  };
  const Eigen::MatrixXd data = inverse(filter_->covariance()) - inverse(prior_covariance_);
  std::vector<bool> out;
  for (Eigen::Index r = 0; r < centers_.cols(); ++r) {
    const Eigen::Index i = patch_model_.first + r;
    out.push_back(data(i, i) * told() * told() > 1.0);
  }
  return out;
}

}  // namespace tissue_stiffness
