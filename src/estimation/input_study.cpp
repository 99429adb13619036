#include "tissue_stiffness/estimation/input_study.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/estimation/input_linearisation.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMostIterations = 6;
constexpr double kNoise = 2.0;  // mean square over the noise's that no other start can better by much
constexpr int kMostCuts = 3;
constexpr double kSettled = 0.1;     // posterior standard deviations
constexpr Eigen::Index kModes = 12;  // along which missing physics is looked for
constexpr double kPlausible = 3.0;   // standard deviations
constexpr double kMisstated = 1.5;   // times its tolerance: what a stated number may be wrong by

Eigen::MatrixXd inverse(const Eigen::MatrixXd& m) {
  return m.ldlt().solve(Eigen::MatrixXd::Identity(m.rows(), m.cols()));
}

// Gauss-Newton on the parameters and the inputs' errors, and what it says.
class InputFit {
 public:
  InputFit(const InputStudy::Question& question, InputModels& models)
      : q_(question),
        models_(models),
        rows_(question, models),
        p_(question.w.size()),
        prior_mean_(models.base.prior_mean()),
        prior_information_(question.prior_std.cwiseAbs2().cwiseInverse()),
        inflation_(Eigen::VectorXd::Ones(rows_.size())) {}

  InputStudy::Answer run() {
    InputStudy::Answer answer;
    answer.asked = q_.w;
    answer.fitted = !models_.base.nonlinear();
    const bool uncertain = rows_.size() > p_;  // else the question's parameters are the fit
    Fit best = fit_from(q_.w, answer.fitted && uncertain);
    if (answer.fitted && uncertain && scale(best.normal) > kNoise) {
      Fit other = fit_from(prior_mean_, true);
      const double s = std::min(scale(best.normal), scale(other.normal));
      if (total(other.z, other.normal, s) < total(best.z, best.normal, s)) best = std::move(other);
    }
    if (answer.fitted) test(best, answer);
    tell_inputs(best.z, inverse(posterior_information(best.normal)), answer);
    if (answer.fitted && uncertain) best = tempered_fit(answer);
    finish(best, answer);
    return answer;
  }

 private:
  struct Fit {
    Eigen::VectorXd z;
    NormalEquations normal;
  };
  Fit fit_from(const Eigen::VectorXd& w, bool iterate) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(rows_.size());
    z.head(p_) = w;
    Fit fit{z, rows_.at(z)};
    for (int k = 0; iterate && k < kMostIterations && improve(fit.z, fit.normal); ++k) {
    }
    return fit;
  }

  // Where a load's course is uncertain, inertia alone tells the modulus, by a small part of the motion, which structure
  // that the residual may hide imitates. So that structure is taken for one error that all rows share, and the data tell as
  // much as a tempered likelihood has it (Miller & Dunson 2019). Inputs that are implausible count as wide as they would
  // have to be.
  Fit tempered_fit(const InputStudy::Answer& answer) {
    const double hidden = std::max(0.0, answer.test.excess()) + answer.test.deviation();
    temperature_ = 1.0 + hidden * answer.test.structured_dof() * rows_.repeated();
    return fit_from(q_.w, true);
  }

  double scale(const NormalEquations& n) const { return temperature_ * std::max(1.0, n.cost / std::max(1.0, n.rows)); }
  Eigen::VectorXd prior() const {
    Eigen::VectorXd out = inflation_.cwiseAbs2().cwiseInverse();
    out.head(p_) = prior_information_;
    return out;
  }
  Eigen::VectorXd from_prior(const Eigen::VectorXd& z) const {
    Eigen::VectorXd out = -z;
    out.head(p_) += prior_mean_;
    return out;
  }
  double total(const Eigen::VectorXd& z, const NormalEquations& n, double scale) const {
    return n.cost / scale + from_prior(z).cwiseAbs2().dot(prior());
  }
  Eigen::MatrixXd posterior_information(const NormalEquations& n) const {
    Eigen::MatrixXd out = n.information / scale(n);
    out.diagonal() += prior();
    return out;
  }

  // One Gauss-Newton step, shortened while the cost does not fall; false at the end.
  bool improve(Eigen::VectorXd& z, NormalEquations& normal) {
    const double s = scale(normal);
    const Eigen::MatrixXd information = posterior_information(normal);
    const Eigen::VectorXd step = information.ldlt().solve(normal.gradient / s + prior().cwiseProduct(from_prior(z)));
    if (step.dot(information * step) < kSettled * kSettled) return false;
    double share = std::min(1.0, (q_.prior_std.array() / step.head(p_).array().abs().max(1e-300)).minCoeff());
    for (int cut = 0; cut < kMostCuts; ++cut, share *= 0.3) {
      const Eigen::VectorXd next = z + share * step;
      const NormalEquations there = rows_.at(next);
      if (!(total(next, there, s) < total(z, normal, s))) continue;
      z = next;
      normal = there;
      return true;
    }
    return false;
  }

  void finish(const Fit& fit, InputStudy::Answer& answer) {
    const double tempered = scale(fit.normal);
    const Eigen::MatrixXd posterior = inverse(posterior_information(fit.normal));
    Eigen::MatrixXd own = temperature_ / tempered * fit.normal.information.topLeftCorner(p_, p_);
    own.diagonal() += prior_information_;
    answer.w = fit.z.head(p_);
    answer.rows = fit.normal.rows;
    answer.from_noise = inverse(own);
    answer.from_loads = posterior.topLeftCorner(p_, p_) - answer.from_noise;
    const Eigen::MatrixXd shifts = (posterior * fit.normal.constants / tempered).topRows(p_);
    answer.from_constants = shifts * shifts.transpose() + scale_shift(shifts, posterior, fit.normal.information / tempered);
    for (const InputLinearisation::Load& load : rows_.loads()) {
      answer.corrections[load.topic] = {load.basis, fit.z.segment(load.first, load.basis.size())};
    }
  }

  void test(const Fit& fit, InputStudy::Answer& answer) {
    rows_.each_row(fit.z, [&](const InputLinearisation::Row& row, const Eigen::MatrixXd&) {
      const Eigen::Index most = std::min<Eigen::Index>(kModes, std::max<Eigen::Index>(1, row.error.size() / 4));
      answer.test.add(row.error, row.precision, row.modes.leftCols(std::min(most, row.modes.cols())));
    });
    const Eigen::MatrixXd left = inverse(posterior_information(fit.normal));
    double fitted = static_cast<double>(p_);
    for (Eigen::Index i = p_; i < rows_.size(); ++i) fitted += std::max(0.0, 1.0 - left(i, i));
    answer.test.set_fitted(fitted);
  }

  // Lengths that are all too large by a share: K grows by it, a mass by its cube, the force of a pressure by its square.
  Eigen::MatrixXd scale_shift(const Eigen::MatrixXd& constant_shifts, const Eigen::MatrixXd& posterior,
                              const Eigen::MatrixXd& information) const {  // of the data alone
    const double tolerance = models_.base.settings().exact_inputs ? 0.0 : models_.base.settings().mesh.scale_tolerance;
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(p_);
    for (Eigen::Index i = 0; i < p_; ++i) {
      if (is_young_modulus(models_.base.free_parameters()[static_cast<std::size_t>(i)].name)) shift[i] -= 1.0;
    }
    for (std::size_t i = 0; i < models_.constants.size(); ++i) {
      const UncertainConstant& c = models_.constants[i];
      if (c.name.find(".density") == std::string::npos) continue;
      shift += 3.0 * (c.value / c.std) * constant_shifts.col(static_cast<Eigen::Index>(i));
    }
    for (const InputLinearisation::Load& load : rows_.loads()) {
      if (load.basis.components() != 1 || load.basis.groups().front().name != "gain") continue;
      shift -= 2.0 / load.basis.groups().front().std * (posterior * information.col(load.first)).head(p_);
    }
    return tolerance * tolerance * shift * shift.transpose();
  }

  void tell_inputs(const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior, InputStudy::Answer& answer) {
    for (const InputLinearisation::Load& load : rows_.loads()) {
      const std::string unit = load.basis.components() == 1 ? "Pa" : "N";
      for (const LoadErrorBasis::Group& group : load.basis.groups()) {
        tell(load.topic, group.name, group.unit.empty() ? unit : group.unit, group.std, load.first + group.first,
             group.count, z, posterior, answer);
      }
      // One sensor: what makes one of its errors implausible is believed of all.
      const double widest = inflation_.segment(load.first, load.basis.size()).maxCoeff();
      inflation_.segment(load.first, load.basis.size()).setConstant(widest);
    }
    for (const InputLinearisation::Pose& pose : rows_.poses()) {
      const std::string topic = models_.base.settings().observations[static_cast<std::size_t>(pose.source)].topic;
      if (pose.offset > 0.0) tell(topic, "pose offset", "m", pose.offset, pose.first, 3, z, posterior, answer);
      if (pose.rotation > 0.0) tell(topic, "pose rotation", "rad", pose.rotation, pose.first + 3, 3, z, posterior, answer);
    }
    for (const UncertainConstant& c : models_.constants) answer.inputs.push_back({c.name, "value", "", c.std, 0.0, c.std});
  }

  // A group whose estimate is further from zero than its tolerance allows is implausible.
  void tell(const std::string& input, const std::string& error, const std::string& unit, double std, Eigen::Index first,
            Eigen::Index count, const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior, InputStudy::Answer& answer) {
    const double n = static_cast<double>(count);
    const double square = z.segment(first, count).squaredNorm();
    const Eigen::VectorXd left = posterior.diagonal().segment(first, count).cwiseMin(1.0);
    const double learnt = (1.0 - left.array()).sum();
    answer.inputs.push_back({input, error, unit, std, std * std::sqrt(square / n), std * std::sqrt(left.mean())});
    const double chance = learnt + kPlausible * std::sqrt(2.0 * learnt);
    if (square <= std::max({chance, kMisstated * kMisstated * learnt, 1.0})) return;
    inflation_.segment(first, count).setConstant(std::sqrt(square / std::max(1.0, learnt)));
    if (!answer.implausible.empty()) return;
    char text[200];
    std::snprintf(text, sizeof text, "the %s of %s would have to be %.3g %s, %.1f times its tolerance", error.c_str(),
                  input.c_str(), std * std::sqrt(square / n), unit.c_str(), std::sqrt(square / n));
    answer.implausible = text;
  }

  const InputStudy::Question& q_;
  const InputModels& models_;
  InputLinearisation rows_;
  double temperature_ = 1.0;
  Eigen::Index p_;
  Eigen::VectorXd prior_mean_, prior_information_;
  Eigen::VectorXd inflation_;  ///< of each nuisance beyond its tolerance; 1: plausible
};

}  // namespace

struct InputStudy::Parts : InputModels {
  using InputModels::InputModels;
};

InputStudy::InputStudy(const Model& model) : parts_(std::make_unique<Parts>(model)) {}
InputStudy::~InputStudy() = default;

InputStudy::Answer InputStudy::study(const Question& question) {
  for (const auto& [topic, course] : question.courses) *parts_->uncertain.courses().at(topic) = course;
  parts_->uncertain.set_first_stamp(question.first_stamp);
  parts_->base.set_first_stamp(question.first_stamp);
  parts_->runs->focus(observed_nodes(parts_->operators, question.frames));
  return InputFit(question, *parts_).run();
}

}  // namespace tissue_stiffness
