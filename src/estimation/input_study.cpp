#include "estimation/input_study.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "estimation/input_linearisation.hpp"
#include "estimation/input_posterior.hpp"
#include "fit/ensemble.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kNoiseSteps = 2;
constexpr double kMoreNoise = 1.2;   // variance over the stated one that is worth another fit
constexpr double kNoise = 2.0;       // mean square over the noise's below which no other start is tried
constexpr Eigen::Index kModes = 12;  // modes along which missing physics is searched
constexpr double kPlausible = 3.0;   // standard deviations
constexpr double kTails = 2.0;       // variance of Student's distribution with 4 degrees of freedom and scale 1

Eigen::MatrixXd inverse(const Eigen::MatrixXd& m) {
  return m.ldlt().solve(Eigen::MatrixXd::Identity(m.rows(), m.cols()));
}

// Returns each nuisance's standard deviation, in units of its tolerance.
Eigen::VectorXd nuisance_stds(const InputLinearisation& rows, Eigen::Index parameters) {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(rows.size() - parameters, std::sqrt(kTails));
  out.tail(rows.size() - rows.first_of_mesh()).setOnes();
  return out;
}

// Fits the parameters and the inputs' errors by Gauss-Newton, and answers the question.
class InputFit {
 public:
  InputFit(const InputStudy::Question& question, InputModels& models)
      : q_(question),
        models_(models),
        rows_(question, models),
        p_(question.w.size()),
        posterior_([this](const Eigen::VectorXd& z) { return rows_.at(z); }, models.base.parameters().prior_mean(),
                   question.prior_std, nuisance_stds(rows_, p_)) {}

  InputStudy::Answer run() {
    InputStudy::Answer answer;
    answer.asked = q_.w;
    answer.fitted = !models_.base.nonlinear();
    const bool uncertain = answer.fitted && rows_.size() > p_;  // else the fit is at the question's parameters
    Fit best = uncertain ? best_mode() : posterior_.at(q_.w);
    if (uncertain) best = with_noise_of_forces(std::move(best));
    if (answer.fitted) answer.test = test(best);
    if (uncertain) {
      best = tempered_fit(answer.test);
      answer.test = test(best);  // input errors that the tempered data do not ask for explain nothing
    }
    tell_inputs(best, answer);
    InputPosterior::Moments moments{best, Eigen::MatrixXd::Zero(rows_.size(), rows_.size())};
    if (uncertain) moments = posterior_.integrate(best);
    finish(best, moments, answer);
    return answer;
  }

 private:
  using Fit = InputPosterior::Fit;

  Fit best_mode() {
    Fit best = posterior_.mode(q_.w);
    if (!(posterior_.scale(best.normal) > kNoise)) return best;
    Fit other = posterior_.mode(models_.base.parameters().prior_mean());
    const double s = std::min(posterior_.scale(best.normal), posterior_.scale(other.normal));
    return posterior_.cost(other, s) < posterior_.cost(best, s) ? other : best;
  }

  // A force has three rows beside hundreds of points', which would hide that it fits badly: the noise of a pose shows in
  // the force that it takes. So the noise of each force sensor is that of its own residual, or as stated where that is
  // more.
  Fit with_noise_of_forces(Fit best) {
    for (int k = 0; k < kNoiseSteps; ++k) {
      bool changed = false;
      for (const auto& [source, sums] : best.normal.forces) {
        const double variance = std::max(1.0, sums[0] / std::max(1.0, sums[1]));
        rows_.set_force_noise(source, variance);
        changed = changed || variance > kMoreNoise;
      }
      if (!changed) break;
      best = posterior_.mode(best.z.head(p_));
    }
    return best;
  }

  // Where a load's course is uncertain, only inertia tells the modulus, by a small part of the motion. Structure that the
  // residual may hide imitates that part. So the structure counts as one error that all rows share, and the likelihood is
  // tempered by as much (Miller & Dunson 2019).
  Fit tempered_fit(const MisfitTest& test) {
    const double hidden = std::max(0.0, test.excess()) + test.deviation();
    posterior_.set_temperature(1.0 + hidden * test.structured_dof() * rows_.repeated());
    return posterior_.mode(q_.w);
  }

  // The mean of a bent valley lies off its floor, so the runs are corrected by the mode.
  void finish(const Fit& mode, const InputPosterior::Moments& moments, InputStudy::Answer& answer) {
    const NormalEquations& normal = moments.mean.normal;
    const double tempered = posterior_.scale(normal);
    const Eigen::MatrixXd information = posterior_.information(normal), covariance = inverse(information);
    Eigen::MatrixXd own = posterior_.temperature() / tempered * normal.information.topLeftCorner(p_, p_);
    own.diagonal() += q_.prior_std.cwiseAbs2().cwiseInverse();
    answer.w = moments.mean.z.head(p_);
    answer.mode = mode.z.head(p_);
    answer.rows = normal.rows;
    answer.from_noise = inverse(own);
    const Eigen::Index inputs = rows_.first_of_mesh();
    const Eigen::MatrixXd on_this_mesh = inverse(information.topLeftCorner(inputs, inputs)).topLeftCorner(p_, p_);
    answer.from_loads = on_this_mesh - answer.from_noise + moments.beyond_linear.topLeftCorner(p_, p_);
    answer.from_mesh = covariance.topLeftCorner(p_, p_) - on_this_mesh;
    const Eigen::MatrixXd shifts = (covariance * normal.constants / tempered).topRows(p_);
    answer.from_constants =
        kTails * (shifts * shifts.transpose() + scale_shift(shifts, covariance, normal.information / tempered));
    for (const InputLinearisation::Load& load : rows_.loads()) {
      answer.corrections[load.topic] = {load.basis, mode.z.segment(load.first, load.basis.size())};
    }
  }

  MisfitTest test(const Fit& fit) {
    MisfitTest out;
    rows_.each_row(fit.z, [&](const InputLinearisation::Row& row, const Eigen::MatrixXd&) {
      const Eigen::Index most = std::min<Eigen::Index>(kModes, std::max<Eigen::Index>(1, row.error.size() / 4));
      out.add(row.error, row.precision, row.modes.leftCols(std::min(most, row.modes.cols())));
    });
    const Eigen::MatrixXd left = posterior_.covariance(fit.normal);
    double fitted = static_cast<double>(p_);
    for (Eigen::Index i = p_; i < rows_.size(); ++i) fitted += posterior_.learnt(left, i);
    out.set_fitted(fitted);
    return out;
  }

  // Lengths may all be too large by one share. Then K grows by it, a mass by its cube, the force of a pressure by its
  // square.
  Eigen::MatrixXd scale_shift(const Eigen::MatrixXd& constant_shifts, const Eigen::MatrixXd& posterior,
                              const Eigen::MatrixXd& information) const {  // of the data alone
    const double tolerance = models_.base.settings().exact_inputs ? 0.0 : models_.base.settings().mesh.scale_tolerance;
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(p_);
    for (Eigen::Index i = 0; i < p_; ++i) {
      if (is_young_modulus(models_.base.parameters().free()[static_cast<std::size_t>(i)].name)) shift[i] -= 1.0;
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

  void tell_inputs(const Fit& fit, InputStudy::Answer& answer) {
    const Eigen::VectorXd& z = fit.z;
    const Eigen::MatrixXd posterior = posterior_.covariance(fit.normal);
    for (const InputLinearisation::Load& load : rows_.loads()) {
      const bool motion = load.course->kind() == LoadInput::Kind::pose;
      const std::string unit = motion ? "m" : load.basis.components() == 1 ? "Pa" : "N";
      for (const LoadErrorBasis::Group& group : load.basis.groups()) {
        tell(load.topic, group.name, group.unit.empty() ? unit : group.unit, group.std, load.first + group.first,
             group.count, z, posterior, answer);
      }
      // All these errors are of one sensor: what makes one of them implausible is believed of all.
      const double widest = posterior_.widest_nuisance_std(load.first, load.basis.size());
      posterior_.set_nuisance_std(load.first, load.basis.size(), widest);
    }
    for (const InputLinearisation::Pose& pose : rows_.poses()) {
      const std::string topic = models_.base.settings().observations[static_cast<std::size_t>(pose.source)].topic;
      if (pose.offset > 0.0) tell(topic, "pose offset", "m", pose.offset, pose.first, 3, z, posterior, answer);
      if (pose.rotation > 0.0) tell(topic, "pose rotation", "rad", pose.rotation, pose.first + 3, 3, z, posterior, answer);
    }
    for (const InputLinearisation::ForceSensor& sensor : rows_.force_sensors()) {
      const std::string topic = models_.base.settings().observations[static_cast<std::size_t>(sensor.source)].topic;
      if (sensor.gain > 0.0) tell(topic, "gain", "-", sensor.gain, sensor.first, 1, z, posterior, answer);
      if (sensor.bias > 0.0) tell(topic, "bias", "N", sensor.bias, sensor.first + 1, 3, z, posterior, answer);
      if (sensor.rotation > 0.0)
        tell(topic, "direction", "rad", sensor.rotation, sensor.first + 4, 3, z, posterior, answer);
    }
    for (const UncertainConstant& c : models_.constants) answer.inputs.push_back({c.name, "value", "", c.std, 0.0, c.std});
  }

  // A group whose estimate is further from zero than its tolerance allows is implausible. It then counts as wide as it
  // would have to be.
  void tell(const std::string& input, const std::string& error, const std::string& unit, double std, Eigen::Index first,
            Eigen::Index count, const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior, InputStudy::Answer& answer) {
    const double n = static_cast<double>(count);
    const double square = z.segment(first, count).squaredNorm();
    const double left = posterior.diagonal().segment(first, count).mean();
    double known = 0.0;  // degrees of freedom that the data determine
    for (Eigen::Index i = first; i < first + count; ++i) known += posterior_.learnt(posterior, i);
    answer.inputs.push_back({input, error, unit, std, std * std::sqrt(square / n), std * std::sqrt(std::min(1.0, left))});
    const double variances = square / std::pow(posterior_.nuisance_std(first), 2);
    if (variances <= std::max(1.0, known + kPlausible * std::sqrt(2.0 * known))) return;
    posterior_.set_nuisance_std(first, count, std::sqrt(square / std::max(1.0, known)));
    if (!answer.implausible.empty()) return;
    char text[200];
    std::snprintf(text, sizeof text, "the %s of %s would have to be %.3g %s, %.1f times its tolerance", error.c_str(),
                  input.c_str(), std * std::sqrt(square / n), unit.c_str(), std::sqrt(square / n));
    answer.implausible = text;
  }

  const InputStudy::Question& q_;
  const InputModels& models_;
  InputLinearisation rows_;
  Eigen::Index p_;
  InputPosterior posterior_;
};

}  // namespace

struct InputStudy::Parts : InputModels {
  using InputModels::InputModels;
};

InputStudy::InputStudy(const Model& model) : parts_(std::make_unique<Parts>(model)) {}
InputStudy::~InputStudy() = default;

InputStudy::Answer InputStudy::study(const Question& question) {
  for (const auto& [topic, course] : question.courses) *parts_->uncertain.loads().courses().at(topic) = course;
  parts_->uncertain.loads().set_first_stamp(question.first_stamp);
  parts_->base.loads().set_first_stamp(question.first_stamp);
  parts_->runs->restrict_output_to(observed_nodes(parts_->operators, question.frames));
  return InputFit(question, *parts_).run();
}

}  // namespace tissue_stiffness
