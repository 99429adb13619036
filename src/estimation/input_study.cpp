#include "tissue_stiffness/estimation/input_study.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "tissue_stiffness/estimation/compare.hpp"
#include "tissue_stiffness/estimation/ensemble.hpp"
#include "tissue_stiffness/forward/load_error_response.hpp"
#include "tissue_stiffness/forward/reduced_trajectory.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostFrames = 150;  // of a long recording, evenly spread
constexpr int kMostIterations = 6;
constexpr double kNoise = 2.0;  // mean square over the noise's that no other start can better by much
constexpr int kMostCuts = 3;
constexpr double kSettled = 0.1;       // posterior standard deviations
constexpr double kConstantStep = 0.5;  // of a tolerance, for its central difference
constexpr Eigen::Index kModes = 12;    // along which missing physics is looked for
constexpr double kPlausible = 3.0;     // standard deviations
constexpr double kMisstated = 1.5;     // times its tolerance: what a stated number may be wrong by

// Poisson's ratio is folded into one matrix while it is known; a model in which it is free keeps it apart.
ModelSettings with_free_ratio(ModelSettings settings) {
  for (EffectSettings& effect : settings.effects) {
    if (effect.name != "elasticity") continue;
    const Quantity ratio = read_parameters(effect)[1];
    if (ratio.estimated() || !(ratio.tolerance > 0.0)) continue;
    std::vector<std::pair<std::string, Value>> entries;
    const std::string path = effect.arguments.path();
    for (const std::string& key : effect.arguments.keys()) {
      entries.emplace_back(key, key != "poisson_ratio" ? effect.arguments.at(key)
                                                       : Value::map({{"mean", Value::number(ratio.value, path)},
                                                                     {"std", Value::number(ratio.tolerance, path)}},
                                                                    path));
    }
    effect.arguments = Value::map(std::move(entries), path);
  }
  return settings;
}

Eigen::MatrixXd inverse(const Eigen::MatrixXd& m) {
  return m.ldlt().solve(Eigen::MatrixXd::Identity(m.rows(), m.cols()));
}

// Rigid translation along and rotation about each axis through the body's middle, 3n x 6.
Eigen::MatrixXd rigid_motions(const TetMesh& mesh) {
  const Eigen::Vector3d middle = mesh.nodes.rowwise().mean();
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(mesh.nodes.size(), 6);
  for (Eigen::Index a = 0; a < mesh.nodes.cols(); ++a) {
    for (int i = 0; i < 3; ++i) {
      out(3 * a + i, i) = 1.0;
      out.block<3, 1>(3 * a, 3 + i) = Eigen::Vector3d::Unit(i).cross(mesh.nodes.col(a) - middle);
    }
  }
  return out;
}

}  // namespace

struct InputStudy::Parts {
  Model base;  ///< the estimator's, for its parameters
  Model uncertain;
  std::unique_ptr<ReducedModel> runs;
  std::vector<std::unique_ptr<ObservationOperator>> operators;
  std::vector<UncertainConstant> constants;
  Eigen::MatrixXd rigid;

  explicit Parts(const Model& model)
      : base(model.settings(), model),
        uncertain(with_free_ratio(model.settings()), model),
        operators(make_observation_operators(base)),
        constants(model.uncertain_constants()),
        rigid(rigid_motions(base.mesh())) {
    BasisOptions basis;
    basis.nonlinear = BasisOptions::Nonlinear::left_out;
    runs = std::make_unique<ReducedModel>(uncertain, basis);
  }
};

namespace {

/// Sums over the frames of what the fit is made of. z = [w; eta]: parameters, then nuisance in units of its tolerance.
struct Normal {
  Eigen::MatrixXd information;  ///< Z^T R^-1 Z of the data
  Eigen::VectorXd gradient;     ///< Z^T R^-1 e
  Eigen::MatrixXd constants;    ///< Z^T R^-1 of the constants' tolerances, a column each
  double cost = 0.0, rows = 0.0;

  Normal(Eigen::Index size, Eigen::Index count)
      : information(Eigen::MatrixXd::Zero(size, size)),
        gradient(Eigen::VectorXd::Zero(size)),
        constants(Eigen::MatrixXd::Zero(size, count)) {}

  /// Counts every frame so many times: it stands for those that were left out.
  void repeat(double times) {
    information *= times;
    gradient *= times;
    constants *= times;
    cost *= times;
    rows *= times;
  }
};

/// One frame, linearised. The columns of the loads' errors are `modes` times their modal amplitudes.
struct Row {
  Eigen::VectorXd error, precision;
  Eigen::MatrixXd parameters, constants, poses;  ///< d row / d each
  Eigen::MatrixXd modes;                         ///< d row / d amplitude of each mode
};

}  // namespace

class InputFit {
 public:
  InputFit(const InputStudy::Question& q, const Model& base, Model& uncertain, ReducedModel& runs,
           const std::vector<std::unique_ptr<ObservationOperator>>& operators,
           const std::vector<UncertainConstant>& constants, const Eigen::MatrixXd& rigid)
      : q_(q),
        base_(base),
        uncertain_(uncertain),
        runs_(runs),
        operators_(operators),
        constants_(constants),
        rigid_(rigid) {
    const std::size_t stride = (q.frames.size() + kMostFrames - 1) / kMostFrames;
    for (std::size_t k = q.frames.size(); k > 0; k -= std::min(k, stride))
      frames_.insert(frames_.begin(), &q.frames[k - 1]);
    repeated_ = static_cast<double>(q.frames.size()) / static_cast<double>(frames_.size());
    p_ = q.w.size();
    prior_mean_ = base.prior_mean();
    prior_information_ = q.prior_std.cwiseAbs2().cwiseInverse();
    size_ = p_;
    if (!base.settings().exact_inputs) {
      for (const auto& [topic, course] : uncertain.courses()) add_load(topic, course);
      for (std::size_t i = 0; i < base.settings().observations.size(); ++i) add_pose(i);
    }
    inflation_ = Eigen::VectorXd::Ones(size_);
  }

  InputStudy::Answer run() {
    InputStudy::Answer answer;
    answer.fitted = !base_.nonlinear();
    Fit best = fit_from(q_.w, answer.fitted);
    if (answer.fitted && scale(best.normal) > kNoise) {
      Fit other = fit_from(prior_mean_, true);
      const double s = std::min(scale(best.normal), scale(other.normal));
      if (total(other.z, other.normal, s) < total(best.z, best.normal, s)) best = std::move(other);
    }
    if (answer.fitted) test(best, answer);
    tell_inputs(best.z, inverse(posterior_information(best.normal)), answer);
    if (answer.fitted && size_ > p_) best = tempered_fit(answer);
    finish(best, answer);
    return answer;
  }

 private:
  struct Load {
    std::string topic;
    std::shared_ptr<Course> course;
    LoadErrorBasis basis;
    Eigen::Index first;
  };
  struct Pose {
    int source;
    double rotation, offset;
    Eigen::Index first;
  };

  void add_load(const std::string& topic, const std::shared_ptr<Course>& course) {
    course->correct({}, {});
    if (course->empty() || course->tolerance().exact()) return;
    const int components = course->acting();
    const auto measured = [&](double t) {
      Eigen::VectorXd load(components);
      for (int i = 0; i < components; ++i) load[i] = course->measured(t, i);
      return load;
    };
    LoadTolerance tolerance = course->tolerance();
    for (const FreeParameter& free : base_.free_parameters()) {
      if (free.name.find("force_scale") == 0) tolerance.gain = 0.0;  // the same number
    }
    const LoadErrorBasis basis(tolerance, measured, components, q_.start, q_.frames.back().time);
    if (basis.size() == 0) return;
    loads_.push_back({topic, course, basis, size_});
    size_ += basis.size();
  }

  void add_pose(std::size_t source) {
    const ObservationSettings& sensor = base_.settings().observations[source];
    if (sensor.rotation == 0.0 && sensor.offset == 0.0) return;
    poses_.push_back({static_cast<int>(source), sensor.rotation, sensor.offset, size_});
    size_ += 6;
  }

  void correct_loads(const Eigen::VectorXd& z) {
    for (const Load& load : loads_) load.course->correct(load.basis, z.segment(load.first, load.basis.size()));
  }

  // Parameters of the centre, of the sigma points around it, and of each constant to either side.
  std::vector<Eigen::VectorXd> points(const Eigen::VectorXd& w) const {
    const Eigen::VectorXd centre = base_.theta(w);
    std::vector<Eigen::VectorXd> out{centre};
    for (const double side : {1.0, -1.0}) {
      for (Eigen::Index i = 0; i < p_; ++i) {
        Eigen::VectorXd moved = w;
        moved[i] += side * q_.spread[i];
        out.push_back(base_.theta(moved));
      }
    }
    for (const double side : {1.0, -1.0}) {
      for (const UncertainConstant& constant : constants_) {
        Eigen::VectorXd theta = centre;
        theta[constant.index] += side * kConstantStep * constant.std;
        out.push_back(std::move(theta));
      }
    }
    return out;
  }

  Row row(const Frame& frame, const std::vector<Eigen::VectorXd>& thetas, const Eigen::MatrixXd& u,
          const Eigen::MatrixXd& shapes, const Eigen::VectorXd& z) const {
    const auto predict = [&](std::size_t i) {
      return predict_frame(base_, operators_, frame, thetas[i], u.col(static_cast<Eigen::Index>(i)));
    };
    const Prediction there = predict(0);
    const auto along = [&](const Eigen::MatrixXd& motions) {
      return predict_along(base_, operators_, frame, thetas[0], u.col(0), there, motions);
    };
    const Eigen::Index rows = there.predicted.size();
    const auto np = static_cast<std::size_t>(p_), nc = constants_.size();
    Row out;
    out.parameters.resize(rows, p_);
    for (std::size_t i = 0; i < np; ++i) {
      const Eigen::VectorXd change = predict(1 + i).predicted - predict(1 + np + i).predicted;
      out.parameters.col(static_cast<Eigen::Index>(i)) = change / (2.0 * q_.spread[static_cast<Eigen::Index>(i)]);
    }
    out.constants.resize(rows, static_cast<Eigen::Index>(nc));
    for (std::size_t i = 0; i < nc; ++i) {
      const std::size_t high = 1 + 2 * np + i;
      out.constants.col(static_cast<Eigen::Index>(i)) =
          (predict(high).predicted - predict(high + nc).predicted) / (2.0 * kConstantStep);
    }
    out.modes = along(shapes);
    out.poses = pose_columns(frame, u.col(0), rows, along);
    Prediction posed = there;
    posed.predicted += out.poses * z.tail(out.poses.cols());
    out.error = there.measured - posed.predicted;
    out.precision = row_weights(posed).cwiseQuotient(there.sigma.cwiseAbs2());
    clean(out);
    return out;
  }

  template <typename Along>
  Eigen::MatrixXd pose_columns(const Frame& frame, const Eigen::VectorXd& u, Eigen::Index rows, const Along& along) const {
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, 6 * static_cast<Eigen::Index>(poses_.size()));
    if (poses_.empty()) return out;
    const Eigen::MatrixXd rigid = along(rigid_);
    Eigen::Index first = 0;
    for (const Observation& observation : frame.observations) {
      const auto& sensor = *operators_[static_cast<std::size_t>(observation.source)];
      const Eigen::Index count = sensor.predict(observation, u).predicted.size();
      for (std::size_t k = 0; k < poses_.size(); ++k) {
        if (poses_[k].source != observation.source) continue;
        const Eigen::Index column = 6 * static_cast<Eigen::Index>(k);
        out.block(first, column, count, 3) = poses_[k].offset * rigid.block(first, 0, count, 3);
        out.block(first, column + 3, count, 3) = poses_[k].rotation * rigid.block(first, 3, count, 3);
      }
      first += count;
    }
    return out;
  }

  static void clean(Row& row) {
    for (Eigen::Index r = 0; r < row.error.size(); ++r) {
      const bool good = std::isfinite(row.error[r]) && std::isfinite(row.precision[r]) &&
                        row.parameters.row(r).allFinite() && row.constants.row(r).allFinite() &&
                        row.poses.row(r).allFinite() && row.modes.row(r).allFinite();
      if (good) continue;
      row.error[r] = row.precision[r] = 0.0;
      for (Eigen::MatrixXd* part : {&row.parameters, &row.constants, &row.poses, &row.modes}) part->row(r).setZero();
    }
  }

  // Shows every frame, linearised at z, with the modal amplitudes of the loads' errors.
  template <typename Visit>
  void each_row(const Eigen::VectorXd& z, const Visit& visit) {
    correct_loads(z);
    const std::vector<Eigen::VectorXd> thetas = points(z.head(p_));
    const auto all = runs_.start_all(thetas, q_.start);
    std::vector<LoadErrorResponse> responses;
    for (const Load& load : loads_) responses.emplace_back(runs_, thetas[0], q_.start, load.course, load.basis);
    const ReducedTrajectory at_rest(runs_, thetas[0], q_.start);
    const Eigen::MatrixXd shapes = at_rest.mode_shapes(static_cast<int>(at_rest.modes()->square.size()));
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(base_.fem().dof_count(), static_cast<Eigen::Index>(thetas.size()));
    Eigen::MatrixXd amplitudes(shapes.cols(), load_columns());
    for (const Frame* frame : frames_) {
      std::vector<double> times;
      for (const Eigen::VectorXd& theta : thetas) times.push_back(frame->time - base_.delay(theta));
      all->advance(times);
      all->displacements(u);
      for (std::size_t i = 0; i < loads_.size(); ++i) {
        responses[i].advance(times[0]);
        // The measured load is too large by B eta: the motion under the true one is smaller.
        amplitudes.middleCols(loads_[i].first - p_, loads_[i].basis.size()) = -responses[i].amplitudes();
      }
      visit(row(*frame, thetas, u, shapes, z), amplitudes);
    }
  }

  Eigen::Index load_columns() const { return size_ - p_ - 6 * static_cast<Eigen::Index>(poses_.size()); }

  Normal linearise(const Eigen::VectorXd& z) {
    Normal out(size_, static_cast<Eigen::Index>(constants_.size()));
    const Eigen::Index l = load_columns(), c = size_ - p_ - l;
    each_row(z, [&](const Row& row, const Eigen::MatrixXd& amplitudes) {
      Eigen::MatrixXd own(row.error.size(), p_ + c);
      own << row.parameters, row.poses;
      const Eigen::MatrixXd weighted = row.precision.asDiagonal() * own, seen = row.precision.asDiagonal() * row.modes;
      const Eigen::MatrixXd direct = weighted.transpose() * own;
      const Eigen::MatrixXd across = (weighted.transpose() * row.modes) * amplitudes;
      const Eigen::VectorXd pull = weighted.transpose() * row.error;
      const Eigen::MatrixXd constants = weighted.transpose() * row.constants;
      out.information.topLeftCorner(p_, p_) += direct.topLeftCorner(p_, p_);
      out.information.topRightCorner(p_, c) += direct.topRightCorner(p_, c);
      out.information.bottomRightCorner(c, c) += direct.bottomRightCorner(c, c);
      out.information.block(0, p_, p_, l) += across.topRows(p_);
      out.information.block(p_, p_ + l, l, c) += across.bottomRows(c).transpose();
      out.information.block(p_, p_, l, l).noalias() +=
          amplitudes.transpose() * ((seen.transpose() * row.modes) * amplitudes);
      out.gradient.head(p_) += pull.head(p_);
      out.gradient.tail(c) += pull.tail(c);
      out.gradient.segment(p_, l) += amplitudes.transpose() * (seen.transpose() * row.error);
      out.constants.topRows(p_) += constants.topRows(p_);
      out.constants.bottomRows(c) += constants.bottomRows(c);
      out.constants.middleRows(p_, l) += amplitudes.transpose() * (seen.transpose() * row.constants);
      out.cost += row.error.dot(row.precision.cwiseProduct(row.error));
      out.rows += static_cast<double>((row.precision.array() > 0.0).count());
    });
    out.information.triangularView<Eigen::StrictlyLower>() = out.information.transpose();
    out.repeat(repeated_);
    return out;
  }

  struct Fit {
    Eigen::VectorXd z;
    Normal normal;
  };
  Fit fit_from(const Eigen::VectorXd& w, bool iterate) {
    Eigen::VectorXd z = Eigen::VectorXd::Zero(size_);
    z.head(p_) = w;
    Fit fit{z, linearise(z)};
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
    temperature_ = 1.0 + hidden * answer.test.structured_dof() * repeated_;
    return fit_from(q_.w, true);
  }

  double scale(const Normal& n) const { return temperature_ * std::max(1.0, n.cost / std::max(1.0, n.rows)); }
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
  double total(const Eigen::VectorXd& z, const Normal& n, double scale) const {
    return n.cost / scale + from_prior(z).cwiseAbs2().dot(prior());
  }
  Eigen::MatrixXd posterior_information(const Normal& n) const {
    Eigen::MatrixXd out = n.information / scale(n);
    out.diagonal() += prior();
    return out;
  }

  // One Gauss-Newton step, shortened while the cost does not fall; false at the end.
  bool improve(Eigen::VectorXd& z, Normal& normal) {
    const double s = scale(normal);
    const Eigen::MatrixXd information = posterior_information(normal);
    const Eigen::VectorXd step = information.ldlt().solve(normal.gradient / s + prior().cwiseProduct(from_prior(z)));
    if (step.dot(information * step) < kSettled * kSettled) return false;
    double share = std::min(1.0, (q_.prior_std.array() / step.head(p_).array().abs().max(1e-300)).minCoeff());
    for (int cut = 0; cut < kMostCuts; ++cut, share *= 0.3) {
      const Eigen::VectorXd next = z + share * step;
      const Normal there = linearise(next);
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
    for (const Load& load : loads_) {
      answer.corrections[load.topic] = {load.basis, fit.z.segment(load.first, load.basis.size())};
    }
    correct_loads(Eigen::VectorXd::Zero(size_));
  }

  void test(const Fit& fit, InputStudy::Answer& answer) {
    each_row(fit.z, [&](const Row& row, const Eigen::MatrixXd&) {
      const Eigen::Index most = std::min<Eigen::Index>(kModes, std::max<Eigen::Index>(1, row.error.size() / 4));
      answer.test.add(row.error, row.precision, row.modes.leftCols(std::min(most, row.modes.cols())));
    });
    const Eigen::MatrixXd left = inverse(posterior_information(fit.normal));
    double fitted = static_cast<double>(p_);
    for (Eigen::Index i = p_; i < size_; ++i) fitted += std::max(0.0, 1.0 - left(i, i));
    answer.test.set_fitted(fitted);
  }

  // Lengths that are all too large by a share: K grows by it, a mass by its cube, the force of a pressure by its square.
  Eigen::MatrixXd scale_shift(const Eigen::MatrixXd& constant_shifts, const Eigen::MatrixXd& posterior,
                              const Eigen::MatrixXd& information) const {  // of the data alone
    const double tolerance = base_.settings().exact_inputs ? 0.0 : base_.settings().mesh.scale_tolerance;
    Eigen::VectorXd shift = Eigen::VectorXd::Zero(p_);
    for (Eigen::Index i = 0; i < p_; ++i) {
      if (is_young_modulus(base_.free_parameters()[static_cast<std::size_t>(i)].name)) shift[i] -= 1.0;
    }
    for (std::size_t i = 0; i < constants_.size(); ++i) {
      const UncertainConstant& c = constants_[i];
      if (c.name.find(".density") == std::string::npos) continue;
      shift += 3.0 * (c.value / c.std) * constant_shifts.col(static_cast<Eigen::Index>(i));
    }
    for (const Load& load : loads_) {
      if (load.basis.components() != 1 || load.basis.groups().front().name != "gain") continue;
      shift -= 2.0 / load.basis.groups().front().std * (posterior * information.col(load.first)).head(p_);
    }
    return tolerance * tolerance * shift * shift.transpose();
  }

  void tell_inputs(const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior, InputStudy::Answer& answer) {
    for (const Load& load : loads_) {
      const std::string unit = load.basis.components() == 1 ? "Pa" : "N";
      for (const LoadErrorBasis::Group& group : load.basis.groups()) {
        tell(load.topic, group.name, group.unit.empty() ? unit : group.unit, group.std, load.first + group.first,
             group.count, z, posterior, answer);
      }
      // One sensor: what makes one of its errors implausible is believed of all.
      const double widest = inflation_.segment(load.first, load.basis.size()).maxCoeff();
      inflation_.segment(load.first, load.basis.size()).setConstant(widest);
    }
    for (const Pose& pose : poses_) {
      const std::string topic = base_.settings().observations[static_cast<std::size_t>(pose.source)].topic;
      if (pose.offset > 0.0) tell(topic, "pose offset", "m", pose.offset, pose.first, 3, z, posterior, answer);
      if (pose.rotation > 0.0) tell(topic, "pose rotation", "rad", pose.rotation, pose.first + 3, 3, z, posterior, answer);
    }
    for (const UncertainConstant& c : constants_) answer.inputs.push_back({c.name, "value", "", c.std, 0.0, c.std});
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
  const Model& base_;
  Model& uncertain_;
  ReducedModel& runs_;
  const std::vector<std::unique_ptr<ObservationOperator>>& operators_;
  const std::vector<UncertainConstant>& constants_;
  const Eigen::MatrixXd& rigid_;
  std::vector<const Frame*> frames_;
  double repeated_ = 1.0, temperature_ = 1.0;
  Eigen::Index p_ = 0, size_ = 0;
  Eigen::VectorXd prior_mean_, prior_information_;
  std::vector<Load> loads_;
  std::vector<Pose> poses_;
  Eigen::VectorXd inflation_;  ///< of each nuisance beyond its tolerance; 1: plausible
};

InputStudy::InputStudy(const Model& model) : parts_(std::make_unique<Parts>(model)) {}
InputStudy::~InputStudy() = default;

InputStudy::Answer InputStudy::study(const Question& question) {
  Parts& s = *parts_;
  for (const auto& [topic, course] : question.courses) *s.uncertain.courses().at(topic) = course;
  s.uncertain.set_first_stamp(question.first_stamp);
  s.base.set_first_stamp(question.first_stamp);
  s.runs->focus(observed_nodes(s.operators, question.frames));
  InputFit fit(question, s.base, s.uncertain, *s.runs, s.operators, s.constants, s.rigid);
  return fit.run();
}

}  // namespace tissue_stiffness
