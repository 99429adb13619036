#include "estimation/input_study.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/fit_alone.hpp"
#include "estimation/joint_rows.hpp"
#include "fit/ensemble.hpp"
#include "forward/study_model.hpp"
#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kNoiseSteps = 2;
constexpr double kMoreNoise = 1.2;  // variance over the stated one that is worth another fit
constexpr double kNoise = 2.0;      // mean square over the noise's below which no other start is tried
constexpr double kPlausible = 3.0;  // standard deviations

Eigen::MatrixXd inverse(const Eigen::MatrixXd& m) {
  return m.ldlt().solve(Eigen::MatrixXd::Identity(m.rows(), m.cols()));
}

// Fits the parameters and the inputs' errors by Gauss-Newton, and answers the question.
class InputFit {
 public:
  explicit InputFit(const JointRows& rows)
      : rows_(rows),
        columns_(rows.columns()),
        p_(rows.parameters().size()),
        posterior_([this](const Eigen::VectorXd& z, Constants constants) { return rows_.at(z, constants); },
                   rows.parameters().prior_mean(), rows.prior_std(), rows.nuisance_std()) {}

  InputStudy::Answer run() {
    InputStudy::Answer answer;
    answer.asked = rows_.asked();
    answer.fitted = true;
    for (std::size_t r = 0; r < rows_.recordings(); ++r)
      answer.fitted = answer.fitted && studied_in_full(rows_.part(r).models.base);
    answer.recordings.resize(rows_.recordings());
    const bool uncertain = answer.fitted && columns_.size() > p_;  // else the fit is at the question's parameters
    Fit best = uncertain ? best_mode() : posterior_.at(answer.asked);
    if (uncertain) best = with_noise_of_forces(std::move(best));
    if (answer.fitted) test(best, answer);
    if (uncertain) {
      best = tempered_fit(answer);
      test(best, answer);  // input errors that the tempered data do not ask for explain nothing
    }
    if (rows_.recordings() > 1 && answer.fitted) compare(best, answer);
    tell_inputs(best, answer);
    InputPosterior::Moments moments{best, Eigen::MatrixXd::Zero(columns_.size(), columns_.size())};
    if (uncertain) moments = posterior_.integrate(best);
    finish(best, moments, answer);
    return answer;
  }

 private:
  using Fit = InputPosterior::Fit;

  Fit best_mode() {
    const Eigen::VectorXd from = rows_.asked();
    Fit best = posterior_.mode(from);
    const Eigen::VectorXd scales = posterior_.scales(best.normal);
    if (!(scales.maxCoeff() > kNoise)) return best;
    Fit other = posterior_.mode(rows_.parameters().prior_mean());
    const Eigen::VectorXd s = scales.cwiseMin(posterior_.scales(other.normal));
    return posterior_.cost(other, s) < posterior_.cost(best, s) ? other : best;
  }

  // A force has three rows beside hundreds of points', which would hide that it is noisier than stated: the noise of a pose
  // shows in the force that it takes. So each force sensor has a noise of its own. What a model misses is smoother, and is
  // left to the test.
  Fit with_noise_of_forces(Fit best) {
    for (int k = 0; k < kNoiseSteps; ++k) {
      bool changed = false;
      for (std::size_t r = 0; r < rows_.recordings(); ++r) {
        for (const auto& [source, variance] : best.normal[r].force_noise) {
          if (!std::isfinite(variance)) continue;
          rows_.part(r).rows.set_force_noise(source, std::max(1.0, variance));
          changed = changed || variance > kMoreNoise;
        }
      }
      if (!changed) break;
      best = posterior_.mode(best.z.head(p_));
    }
    return best;
  }

  // Where a load's course is uncertain, only inertia tells the modulus, by a small part of the motion.
  Fit tempered_fit(const InputStudy::Answer& answer) {
    for (std::size_t r = 0; r < rows_.recordings(); ++r) {
      if (!rows_.part(r).predicted) posterior_.set_temperature(r, rows_.temperature(r, answer.recordings[r].test));
    }
    return posterior_.mode(rows_.asked());
  }

  // The mean of a bent valley lies off its floor, so the runs are corrected by the mode.
  void finish(const Fit& mode, const InputPosterior::Moments& moments, InputStudy::Answer& answer) {
    const Eigen::VectorXd scales = posterior_.scales(moments.mean.normal);
    const NormalEquations normal = posterior_.sum(moments.mean.normal, scales);
    const Eigen::MatrixXd information = posterior_.information(moments.mean.normal), covariance = inverse(information);
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(p_, p_);
    for (std::size_t r = 0; r < rows_.recordings(); ++r) {
      InputStudy::OfRecording& out = answer.recordings[r];
      const double tempered = scales[static_cast<Eigen::Index>(r)];
      out.information = posterior_.temperature(r) / tempered * moments.mean.normal[r].information.topLeftCorner(p_, p_);
      out.rows = moments.mean.normal[r].rows;
      own += out.information;
      tell_corrections(r, mode.z, out);
    }
    own.diagonal() += rows_.prior_std().cwiseAbs2().cwiseInverse();
    answer.w = moments.mean.z.head(p_);
    answer.mode = mode.z.head(p_);
    answer.from_noise = inverse(own);
    const Eigen::Index inputs = columns_.first_of_mesh();
    const Eigen::MatrixXd on_this_mesh = inverse(information.topLeftCorner(inputs, inputs)).topLeftCorner(p_, p_);
    answer.from_loads = on_this_mesh - answer.from_noise + moments.beyond_linear.topLeftCorner(p_, p_);
    answer.from_mesh = covariance.topLeftCorner(p_, p_) - on_this_mesh;
    const Eigen::MatrixXd shifts = (covariance * normal.constants).topRows(p_);
    answer.from_constants = kTails * (shifts * shifts.transpose() + scale_shift(shifts, covariance, normal.information));
  }

  void tell_corrections(std::size_t recording, const Eigen::VectorXd& z, InputStudy::OfRecording& out) const {
    const Eigen::VectorXd own = columns_.of(recording, z);
    for (const InputLinearisation::Load& load : rows_.part(recording).rows.loads()) {
      out.corrections[load.topic] = {load.basis, own.segment(load.first, load.basis.size())};
    }
  }

  void test(const Fit& fit, InputStudy::Answer& answer) {
    const Eigen::MatrixXd left = posterior_.covariance(fit.normal);
    const Eigen::VectorXd scales = posterior_.scales(fit.normal);
    const InputPosterior::Tolerated tolerated = posterior_.tolerated(fit.normal);
    for (std::size_t r = 0; r < rows_.recordings(); ++r) {
      if (rows_.part(r).predicted) continue;
      const auto& information = fit.normal[r].information / scales[static_cast<Eigen::Index>(r)];
      answer.recordings[r].test = rows_.test(r, fit.z, left.cwiseProduct(information).sum(), tolerated);
    }
  }

  // Each recording's own estimate is compared with that of all others.
  void compare(const Fit& fit, InputStudy::Answer& answer) {
    std::vector<LinearFit> alone;
    for (std::size_t r = 0; r < rows_.recordings(); ++r) {
      MisfitTest test;
      alone.push_back(fit_alone(rows_, r, fit.z, test));
      if (!rows_.part(r).predicted) continue;
      answer.recordings[r].test = test;
      answer.recordings[r].mode = with_own_parameters(rows_, r, fit.z).head(p_);
    }
    const NormalPrior prior{rows_.parameters().prior_mean(), rows_.prior_std(), rows_.nuisance_std()};
    for (std::size_t r = 0; r < rows_.recordings(); ++r) {
      LinearFit others{Eigen::MatrixXd::Zero(columns_.size(), columns_.size()), Eigen::VectorXd::Zero(columns_.size())};
      for (std::size_t k = 0; k < rows_.recordings(); ++k) {
        if (k != r && !rows_.part(k).predicted) others.add(alone[k]);
      }
      answer.recordings[r].agreement = agreement(alone[r], others, prior);
    }
  }

  // Lengths may all be too large by one share. Then K grows by it, a mass by its cube, the force of a pressure by its
  // square.
  Eigen::MatrixXd scale_shift(const Eigen::MatrixXd& constant_shifts, const Eigen::MatrixXd& posterior,
                              const Eigen::MatrixXd& information) const {  // of the data alone
    const ModelSettings& settings = rows_.part(0).models.base.settings();
    const double tolerance = settings.exact_inputs ? 0.0 : settings.mesh.scale_tolerance;
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(p_);
    for (Eigen::Index i = 0; i < p_; ++i) {
      if (is_young_modulus(rows_.parameters().all()[static_cast<std::size_t>(i)].free.name)) shift[i] -= 1.0;
    }
    for (std::size_t i = 0; i < columns_.constants().size(); ++i) {
      const UncertainConstant& c = columns_.constants()[i];
      if (c.name.find(".density") == std::string::npos) continue;
      shift += 3.0 * (c.value / c.std) * constant_shifts.col(static_cast<Eigen::Index>(i));
    }
    for (const InputGroup& group : columns_.inputs()) {
      if (!group.pressure || group.error != "gain") continue;
      shift -= 2.0 / group.tolerance * (posterior * information.col(group.first)).head(p_);
    }
    return tolerance * tolerance * shift * shift.transpose();
  }

  // Returns the largest standard deviation of the moduli, which are logarithms, that a covariance of the parameters holds;
  // that of the first parameter where no modulus is free.
  double modulus_std(const Eigen::MatrixXd& covariance) const {
    double out = 0.0;
    bool any = false;
    for (Eigen::Index i = 0; i < p_; ++i) {
      if (!is_young_modulus(rows_.parameters().all()[static_cast<std::size_t>(i)].free.name)) continue;
      out = std::max(out, std::sqrt(std::max(0.0, covariance(i, i))));
      any = true;
    }
    return any || p_ == 0 ? out : std::sqrt(std::max(0.0, covariance(0, 0)));
  }

  // Tells first what moves the modulus most.
  void tell_inputs(const Fit& fit, InputStudy::Answer& answer) {
    const Eigen::MatrixXd posterior = posterior_.covariance(fit.normal);
    for (const InputGroup& group : columns_.inputs()) {
      if (group.tolerance > 0.0) tell(group, fit.z, posterior, answer);
    }
    tell_constants(fit, posterior, answer);
    std::stable_sort(answer.inputs.begin(), answer.inputs.end(),
                     [](const InputUncertainty& a, const InputUncertainty& b) { return a.modulus_std > b.modulus_std; });
    // All errors of a load are of one sensor: what makes one of them implausible is believed of all.
    std::map<int, double> widest;
    for (const InputGroup& group : columns_.inputs()) {
      double& std = widest[group.load];
      std = std::max(std, posterior_.widest_nuisance_std(group.first, group.count));
    }
    for (const InputGroup& group : columns_.inputs()) {
      if (group.load >= 0) posterior_.set_nuisance_std(group.first, group.count, widest[group.load]);
    }
  }

  // Constants are considered and not estimated, so they move the parameters by their whole tolerances.
  void tell_constants(const Fit& fit, const Eigen::MatrixXd& posterior, InputStudy::Answer& answer) const {
    const NormalEquations normal = posterior_.sum(fit.normal, posterior_.scales(fit.normal));
    const Eigen::MatrixXd shifts = (posterior * normal.constants).topRows(p_);
    for (std::size_t i = 0; i < columns_.constants().size(); ++i) {
      const UncertainConstant& c = columns_.constants()[i];
      const auto shift = shifts.col(static_cast<Eigen::Index>(i));
      const std::string unit = c.index == UncertainConstant::surface ? "m" : "";
      answer.inputs.push_back({c.name, "value", unit, c.std, 0.0, c.std, modulus_std(kTails * shift * shift.transpose())});
    }
  }

  // Returns what exact knowledge of these errors would take off the parameters' covariance.
  Eigen::MatrixXd caused_by(const InputGroup& group, const Eigen::MatrixXd& posterior) const {
    const Eigen::MatrixXd across = posterior.block(0, group.first, p_, group.count);
    return across * posterior.block(group.first, group.first, group.count, group.count).ldlt().solve(across.transpose());
  }

  // A group whose estimate is further from zero than its tolerance allows is implausible. It then counts as wide as it
  // would have to be.
  void tell(const InputGroup& group, const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior,
            InputStudy::Answer& answer) {
    const Eigen::Index first = group.first, count = group.count;
    const double n = static_cast<double>(count);
    const double square = z.segment(first, count).squaredNorm();
    const double left = posterior.diagonal().segment(first, count).mean();
    double known = 0.0;  // degrees of freedom that the data determine
    for (Eigen::Index i = first; i < first + count; ++i) known += posterior_.learnt(posterior, i);
    answer.inputs.push_back({group.input, group.error, group.unit, group.tolerance, group.tolerance * std::sqrt(square / n),
                             group.tolerance * std::sqrt(std::min(1.0, left)), modulus_std(caused_by(group, posterior))});
    const double variances = square / std::pow(posterior_.nuisance_std(first), 2);
    if (variances <= std::max(1.0, known + kPlausible * std::sqrt(2.0 * known))) return;
    posterior_.set_nuisance_std(first, count, std::sqrt(square / std::max(1.0, known)));
    if (!answer.implausible.empty()) return;
    answer.implausible =
        formatted("the %s of %s would have to be %.3g %s, %.1f times its tolerance", group.error.c_str(),
                  group.input.c_str(), group.tolerance * std::sqrt(square / n), group.unit.c_str(), std::sqrt(square / n));
  }

  const JointRows& rows_;
  const SharedColumns& columns_;
  Eigen::Index p_;
  InputPosterior posterior_;
};

}  // namespace

struct InputStudy::Parts {
  Sharing sharing;
  SharedParameters parameters;
  std::vector<std::unique_ptr<InputModels>> models;
};

InputStudy::InputStudy(const Model& model) : InputStudy({&model}, {{"the recording"}, {}}) {}
InputStudy::InputStudy(const std::vector<const Model*>& models, Sharing sharing)
    : parts_(new Parts{sharing, SharedParameters(sharing, models), {}}) {
  for (const Model* model : models) parts_->models.push_back(std::make_unique<InputModels>(*model));
}
InputStudy::~InputStudy() = default;

InputStudy::Answer InputStudy::study(const Question& question) {
  return study(std::vector<const Question*>{&question}, {false});
}

InputStudy::Answer InputStudy::study(const std::vector<const Question*>& questions, const std::vector<bool>& predicted) {
  JointRows::Parts parts;
  for (std::size_t r = 0; r < questions.size(); ++r) {
    const Question& question = *questions[r];
    InputModels& models = *parts_->models[r];
    question.drive(models.uncertain);
    models.base.loads().set_first_stamp(question.first_stamp);
    models.grow_basis(question);
    const std::vector<int> nodes = observed_nodes(models.operators, question.frames);
    models.runs->restrict_output_to(nodes);
    if (models.offset) models.offset->runs->restrict_output_to(nodes);
    parts.push_back(std::make_unique<JointRows::Part>(question, models, predicted[r]));
  }
  const JointRows rows(std::move(parts), parts_->sharing, parts_->parameters);
  return InputFit(rows).run();
}

}  // namespace tissue_stiffness
