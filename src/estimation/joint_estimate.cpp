#include "estimation/joint_estimate.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "estimation/basis_error.hpp"
#include "estimation/identify.hpp"
#include "estimation/input_study.hpp"
#include "estimation/mesh_error.hpp"
#include "estimation/posterior.hpp"
#include "estimation/state_judgement.hpp"
#include "estimation/systematic_error.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Returns the root mean square of the noise that the model file states, over all lengths [m].
double noise_of(const BodyRecording& given) {
  double sum = 0.0, rows = 0.0;
  for (const Frame& frame : given.recording.frames) {
    for (const Observation& observation : frame.observations) {
      if (traits_of(observation.kind).force) continue;
      const auto count = static_cast<double>(observation.row_count());
      sum += count * std::pow(given.settings.observations[static_cast<std::size_t>(observation.source)].noise, 2);
      rows += count;
    }
  }
  return std::sqrt(sum / rows);
}

// Studies what mesh and inputs do to a joint fit, and makes the estimate of all of it.
class JointStudy {
 public:
  JointStudy(JointFit& fit, const JointProgress& progress)
      : fit_(fit), progress_(progress), shared_(fit.shared()), prior_(shared_.prior_std()) {}

  JointEstimate run() {
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      RecordingSummary summary;
      summary.name = fit_.given(r).name;
      summary.predicted = fit_.given(r).predicted;
      summary.frames = fit_.given(r).recording.frames.size();
      summary.alone = fit_.alone(r);
      out_.recordings.push_back(std::move(summary));
      questions_.push_back(question(r));
    }
    study_meshes();
    study_inputs();
    combine();
    for (std::size_t r = 0; r < fit_.size(); ++r) compare(r);
    judge();
    describe();
    return std::move(out_);
  }

 private:
  MeshError::Question question(std::size_t r) const {
    const Model& model = fit_.fit(r).model();
    MeshError::Question out(model, fit_.given(r).recording.frames, shared_.of(r, fit_.filter().mean()),
                            shared_.of(r, fit_.filter().spread()), model.parameters().prior_std());
    out.checkpoint = fit_.given(r).recording.checkpoint;
    return out;
  }

  void study_meshes() {
    meshes_.resize(fit_.size());
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      Mesh& mesh = meshes_[r];
      const Model& model = fit_.fit(r).model();
      progress_("study the mesh of " + fit_.given(r).name, r, fit_.size());
      mesh.unknown = MeshError::why_not(model);
      if (!mesh.unknown.empty()) continue;
      try {
        MeshError study(model, model.parameters().theta(questions_[r].w));
        const MeshError::Answer answer = study.study(questions_[r]);
        questions_[r].mesh_changes = study.changes(questions_[r], answer.shift);
        mesh.shift = fit_.given(r).predicted ? answer.shift : answer.believed(fit_.misfit_scale(r));
        mesh.left = answer.left;
      } catch (const NumericalError& error) {
        mesh.unknown = error.what();
      }
    }
  }

  void study_inputs() {
    progress_("study the inputs", 0, 1);
    std::vector<const MeshError::Question*> questions;
    std::vector<bool> predicted;
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      questions.push_back(&questions_[r]);
      predicted.push_back(fit_.given(r).predicted);
    }
    inputs_ = InputStudy(fit_.models(), fit_.sharing()).study(questions, predicted);
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      MisfitTest& test = inputs_.recordings[r].test;
      test.set_numerics(of_mesh(r));
      out_.recordings[r].test = test;
      out_.recordings[r].agreement = inputs_.recordings[r].agreement;
    }
  }

  double of_mesh(std::size_t r) const { return kFinerLeaves * meshes_[r].left; }

  // Returns what the joint fit makes of a shift of each recording's own fit (empty: none).
  Eigen::VectorXd joint_shift(const std::vector<Eigen::VectorXd>& shifts) const {
    Eigen::MatrixXd information = prior_.cwiseAbs2().cwiseInverse().asDiagonal();
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(prior_.size());
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      if (fit_.given(r).predicted) continue;
      const Eigen::MatrixXd& own = inputs_.recordings[r].information;
      information += own;
      if (shifts[r].size() == 0) continue;
      Eigen::VectorXd shift = Eigen::VectorXd::Zero(prior_.size());
      for (Eigen::Index i = 0; i < shifts[r].size(); ++i) {
        const Eigen::Index at = shared_.columns(r)[static_cast<std::size_t>(i)];
        shift[at] = shifts[r][i];
        pull[at] += shifts[r][i] / (prior_[at] * prior_[at]);  // because the prior held this shift, too
      }
      pull += own * shift;
    }
    return information.ldlt().solve(pull);
  }

  Eigen::VectorXd mesh_shift() const {
    std::vector<Eigen::VectorXd> out;
    for (const Mesh& mesh : meshes_) out.push_back(mesh.shift);
    return joint_shift(out);
  }

  Eigen::VectorXd basis_shifts() const {
    std::vector<Eigen::VectorXd> out(fit_.size());
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      const RecordingFit& fit = fit_.fit(r);
      if (fit_.given(r).predicted || fit.model().nonlinear()) continue;
      out[r] = basis_shift(*fit.reduced(), fit.whole(), questions_[r].w, questions_[r].spread, questions_[r].prior_std);
    }
    return joint_shift(out);
  }

  // A misfit may lie along what the parameters do, in all rows, frames and recordings alike (Kennedy & O'Hagan 2001).
  Eigen::MatrixXd discrepancy() const {
    const Eigen::MatrixXd covariance = inputs_.from_noise;
    Eigen::MatrixXd scores = Eigen::MatrixXd::Zero(prior_.size(), prior_.size());
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      if (fit_.given(r).predicted) continue;
      const InputStudy::OfRecording& of = inputs_.recordings[r];
      const bool passes = inputs_.implausible.empty() &&
                          (inputs_.fitted ? of.test.passes() : fit_.misfit_scale(r) <= kFullSigmas * kFullSigmas);
      const double unexplained = passes ? 0.0 : std::max(0.0, fit_.misfit_scale(r) - of.test.noise_level() - of_mesh(r));
      const double square = std::max(of.test.discrepancy(), unexplained);
      const Eigen::MatrixXd in_prior = prior_.asDiagonal() * of.information * prior_.asDiagonal();
      const Eigen::MatrixXd root = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(in_prior).operatorSqrt();
      scores += std::sqrt(square * of.rows) * prior_.cwiseInverse().asDiagonal() * root;
    }
    return covariance * scores * scores.transpose() * covariance;
  }

  // Returns by how much the recordings differ more than their errors allow, as a factor on the variance.
  double disagreement() const {
    double out = 1.0;
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      const Agreement& agreement = inputs_.recordings[r].agreement;
      if (!fit_.given(r).predicted && !agreement.passes()) out = std::max(out, agreement.chi2 / agreement.dof);
    }
    return out;
  }

  void combine() {
    believed_ = inputs_.fitted && inputs_.implausible.empty();
    for (std::size_t r = 0; r < fit_.size(); ++r)
      believed_ = believed_ && (fit_.given(r).predicted || inputs_.recordings[r].test.passes());
    const Eigen::VectorXd mesh = mesh_shift(), basis = basis_shifts();
    runs_at_ = believed_ ? inputs_.w : fit_.filter().mean();
    Eigen::VectorXd mean = runs_at_;
    if (fit_.studied_in_full()) mean -= mesh;
    Eigen::MatrixXd noise = fit_.filter().robust_covariance() + basis * basis.transpose();
    Eigen::MatrixXd loads = inputs_.from_loads;
    if (inputs_.fitted && !believed_) {
      const Eigen::VectorXd apart = inputs_.w - runs_at_;
      loads += apart * apart.transpose();
    }
    const Eigen::MatrixXd of_mesh = mesh_discrepancy(shared_.free(), !fit_.studied_in_full(), mesh) + inputs_.from_mesh;
    Eigen::MatrixXd model = discrepancy() + (disagreement() - 1.0) * (noise + loads + of_mesh);
    model = within_prior(model, prior_);
    covariance_ = noise + loads + of_mesh + inputs_.from_constants + model;
    out_.estimate = summarise_posterior(shared_.free(), mean, covariance_);
    out_.estimate.inputs = inputs_.inputs;
    for (Eigen::Index i = 0; i < prior_.size(); ++i) {
      const double all = covariance_(i, i);
      out_.estimate.variance.push_back({noise(i, i) / all, of_mesh(i, i) / all, loads(i, i) / all,
                                        inputs_.from_constants(i, i) / all, model(i, i) / all});
      out_.recording.push_back(shared_.all()[static_cast<std::size_t>(i)].recording);
    }
    identify_all();
  }

  // What one recording makes absolute is so for all.
  void identify_all() {
    const auto rank = [](const Identifiability& i) {
      return i.verdict == "absolute" ? 2 : i.verdict == "ratio_only" ? 1 : 0;
    };
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      if (fit_.given(r).predicted) continue;
      const std::vector<Eigen::Index>& columns = shared_.columns(r);
      const auto count = static_cast<Eigen::Index>(columns.size());
      Eigen::MatrixXd own(count, count);
      for (Eigen::Index i = 0; i < count; ++i) {
        for (Eigen::Index j = 0; j < count; ++j)
          own(i, j) = covariance_(columns[static_cast<std::size_t>(i)], columns[static_cast<std::size_t>(j)]);
      }
      for (auto& [name, found] : identify(fit_.fit(r).model(), own)) {
        const auto [known, is_new] = out_.identifiable.try_emplace(name, found);
        if (!is_new && rank(found) > rank(known->second)) known->second = found;
      }
    }
  }

  // Runs freely at the joint estimate.
  void compare(std::size_t r) {
    const InputStudy::OfRecording& of = inputs_.recordings[r];
    if (believed_) {
      for (const auto& [topic, correction] : of.corrections)
        fit_.fit(r).correct(topic, correction.basis, correction.coefficients);
    }
    Eigen::VectorXd all = runs_at_;
    for (const Eigen::Index i : shared_.columns(r)) {
      const bool own = shared_.all()[static_cast<std::size_t>(i)].recording == static_cast<int>(r);
      if (own && of.mode.size() > 0) all[i] = of.mode[i];
    }
    const Eigen::VectorXd w = shared_.of(r, all);
    RecordingSummary& out = out_.recordings[r];
    double error = 0.0, motion = 0.0, lengths = 0.0, sigmas = 0.0, rows = 0.0;
    for (const Misfit& misfit : fit_.fit(r).show(w, [](const FreeFrame&) {})) {
      error += misfit.lengths * misfit.rms * misfit.rms;
      motion += misfit.lengths * misfit.motion_rms * misfit.motion_rms;
      lengths += misfit.lengths;
      sigmas += misfit.count * misfit.rms_sigma * misfit.rms_sigma;
      rows += misfit.count;
    }
    out.rms_error = std::sqrt(error / lengths);
    out.motion_rms = std::sqrt(motion / lengths);
    out.rms_sigma = std::sqrt(sigmas / rows);
    out.lengths = lengths;
    out.noise_rms = noise_of(fit_.given(r));
  }

  void judge() {
    Estimate& estimate = out_.estimate;
    const auto say = [&](EstimateState state, std::string reason) {
      estimate.state = state;
      estimate.state_reason = std::move(reason);
    };
    for (const RecordingSummary& r : out_.recordings) {
      if (!r.predicted && r.rms_sigma > kInvalidSigmas)
        return say(EstimateState::model_invalid, r.name + ": no value of the parameters explains the motion");
    }
    if (!inputs_.implausible.empty()) return say(EstimateState::doubtful, inputs_.implausible);
    for (const RecordingSummary& r : out_.recordings) {
      if (r.predicted) continue;
      if (inputs_.fitted && !r.test.passes()) return say(EstimateState::doubtful, r.name + ": " + misfit_text(r.test));
      if (!inputs_.fitted && r.rms_sigma > kFullSigmas)
        return say(EstimateState::doubtful, r.name + ": the misfit is not about the noise");
    }
    for (const RecordingSummary& r : out_.recordings) {
      if (!r.predicted && !r.agreement.passes())
        return say(EstimateState::doubtful, r.name + " asks for other parameters than the rest");
    }
    if (std::string why = unlearnt(shared_.free(), covariance_, StateLimits().converged_within); !why.empty())
      return say(EstimateState::converging, std::move(why));
    say(EstimateState::converged, "the misfit of every recording is noise");
  }

  void describe() {
    for (std::size_t r = 0; r < fit_.size(); ++r) {
      const std::string& why = meshes_[r].unknown;
      out_.description.push_back(fit_.given(r).name + ": " + fit_.fit(r).whole().forward.description() + "; mesh error: " +
                                 (why.empty() ? "from a mesh refined eightfold" : "not assessed, " + why));
    }
  }

  // What a refinement of a recording's mesh tells.
  struct Mesh {
    Eigen::VectorXd shift;  // empty: not known
    double left = 0.0;      // mean square that the mesh leaves
    std::string unknown;    // reason; empty: it was studied
  };

  JointFit& fit_;
  const JointProgress& progress_;
  const SharedParameters& shared_;
  Eigen::VectorXd prior_;  // standard deviations
  JointEstimate out_;
  std::vector<MeshError::Question> questions_;
  std::vector<Mesh> meshes_;
  InputStudy::Answer inputs_;
  bool believed_ = false;    // the estimated errors of the inputs
  Eigen::VectorXd runs_at_;  // parameters of the free runs
  Eigen::MatrixXd covariance_;
};

}  // namespace

JointEstimate estimate_jointly(const std::vector<BodyRecording>& recordings, const std::vector<std::string>& own,
                               const JointProgress& progress) {
  JointFit fit(recordings, own, progress);
  fit.run();
  return JointStudy(fit, progress).run();
}

}  // namespace tissue_stiffness
