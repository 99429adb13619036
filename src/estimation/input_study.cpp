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
constexpr int kMostIterations = 4;
constexpr int kMostCuts = 3;
constexpr double kSettled = 0.1;       // posterior standard deviations
constexpr double kConstantStep = 0.5;  // of a tolerance, for its central difference
constexpr int kModes = 12;             // along which missing physics is looked for
constexpr double kPlausible = 3.0;     // standard deviations

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
};

struct Row {
  Eigen::VectorXd error, precision;
  Eigen::MatrixXd z, constants, modes;
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
    for (const auto& [topic, course] : uncertain.courses()) add_load(topic, course);
    for (std::size_t i = 0; i < base.settings().observations.size(); ++i) add_pose(i);
  }

  InputStudy::Answer run() {
    InputStudy::Answer answer;
    answer.fitted = !base_.nonlinear();
    Eigen::VectorXd z = Eigen::VectorXd::Zero(size_);
    z.head(p_) = q_.w;
    Normal normal = linearise(z);
    for (int k = 0; answer.fitted && k < kMostIterations; ++k) {
      if (!improve(z, normal)) break;
    }
    finish(z, normal, answer);
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
          const std::vector<LoadErrorResponse>& responses, const Eigen::MatrixXd& shapes, const Eigen::VectorXd& z) {
    const auto predict = [&](std::size_t i) {
      return predict_frame(base_, operators_, frame, thetas[i], u.col(static_cast<Eigen::Index>(i)));
    };
    const Prediction there = predict(0);
    const auto along = [&](const Eigen::MatrixXd& motions) {
      return predict_along(base_, operators_, frame, thetas[0], u.col(0), there, motions);
    };
    const Eigen::Index rows = there.predicted.size();
    Row out;
    out.z = Eigen::MatrixXd::Zero(rows, size_);
    const auto np = static_cast<std::size_t>(p_), nc = constants_.size();
    for (std::size_t i = 0; i < np; ++i) {
      const Eigen::VectorXd change = predict(1 + i).predicted - predict(1 + np + i).predicted;
      out.z.col(static_cast<Eigen::Index>(i)) = change / (2.0 * q_.spread[static_cast<Eigen::Index>(i)]);
    }
    out.constants.resize(rows, static_cast<Eigen::Index>(nc));
    for (std::size_t i = 0; i < nc; ++i) {
      const std::size_t high = 1 + 2 * np + i;
      out.constants.col(static_cast<Eigen::Index>(i)) =
          (predict(high).predicted - predict(high + nc).predicted) / (2.0 * kConstantStep);
    }
    // The measured load is too large by B eta: the motion under the true one is smaller.
    for (std::size_t i = 0; i < loads_.size(); ++i) {
      out.z.middleCols(loads_[i].first, loads_[i].basis.size()) = -along(responses[i].displacements());
    }
    Eigen::VectorXd posed = there.predicted;
    if (!poses_.empty()) {
      const Eigen::MatrixXd rigid = along(rigid_);
      Eigen::Index first = 0;
      for (const Observation& observation : frame.observations) {
        const Eigen::Index count =
            operators_[static_cast<std::size_t>(observation.source)]->predict(observation, u.col(0)).predicted.size();
        for (const Pose& pose : poses_) {
          if (pose.source != observation.source) continue;
          out.z.block(first, pose.first, count, 3) = pose.offset * rigid.block(first, 0, count, 3);
          out.z.block(first, pose.first + 3, count, 3) = pose.rotation * rigid.block(first, 3, count, 3);
          posed.segment(first, count) += out.z.block(first, pose.first, count, 6) * z.segment(pose.first, 6);
        }
        first += count;
      }
    }
    Prediction with_pose = there;
    with_pose.predicted = posed;
    out.error = there.measured - posed;
    out.precision = row_weights(with_pose).cwiseQuotient(there.sigma.cwiseAbs2());
    if (shapes.size() > 0) {
      const Eigen::Index most = std::max<Eigen::Index>(1, rows / 4);
      out.modes = along(shapes.leftCols(std::min(shapes.cols(), most)));
    }
    clean(out);
    return out;
  }

  static void clean(Row& row) {
    for (Eigen::Index r = 0; r < row.error.size(); ++r) {
      const bool good = std::isfinite(row.error[r]) && std::isfinite(row.precision[r]) && row.z.row(r).allFinite() &&
                        row.constants.row(r).allFinite() && (row.modes.size() == 0 || row.modes.row(r).allFinite());
      if (good) continue;
      row.error[r] = row.precision[r] = 0.0;
      row.z.row(r).setZero();
      row.constants.row(r).setZero();
      if (row.modes.size() > 0) row.modes.row(r).setZero();
    }
  }

  template <typename Visit>
  void each_row(const Eigen::VectorXd& z, bool with_modes, const Visit& visit) {
    correct_loads(z);
    const std::vector<Eigen::VectorXd> thetas = points(z.head(p_));
    const auto all = runs_.start_all(thetas, q_.start);
    std::vector<LoadErrorResponse> responses;
    for (const Load& load : loads_) responses.emplace_back(runs_, thetas[0], q_.start, load.course, load.basis);
    Eigen::MatrixXd shapes;
    if (with_modes) {
      const ReducedTrajectory at_rest(runs_, thetas[0], q_.start);
      shapes = at_rest.mode_shapes(std::min(kModes, static_cast<int>(at_rest.modes()->square.size())));
    }
    Eigen::MatrixXd u = Eigen::MatrixXd::Zero(base_.fem().dof_count(), static_cast<Eigen::Index>(thetas.size()));
    for (const Frame* frame : frames_) {
      std::vector<double> times;
      for (const Eigen::VectorXd& theta : thetas) times.push_back(frame->time - base_.delay(theta));
      all->advance(times);
      all->displacements(u);
      for (LoadErrorResponse& response : responses) response.advance(times[0]);
      visit(row(*frame, thetas, u, responses, shapes, z));
    }
  }

  Normal linearise(const Eigen::VectorXd& z) {
    Normal out(size_, static_cast<Eigen::Index>(constants_.size()));
    each_row(z, false, [&](const Row& row) {
      const Eigen::MatrixXd weighted = row.precision.asDiagonal() * row.z;
      out.information += repeated_ * row.z.transpose() * weighted;
      out.gradient += repeated_ * weighted.transpose() * row.error;
      out.constants += repeated_ * weighted.transpose() * row.constants;
      out.cost += repeated_ * row.error.dot(row.precision.cwiseProduct(row.error));
      out.rows += repeated_ * static_cast<double>((row.precision.array() > 0.0).count());
    });
    return out;
  }

  double scale(const Normal& n) const { return std::max(1.0, n.cost / std::max(1.0, n.rows)); }
  Eigen::VectorXd prior() const {
    Eigen::VectorXd out = Eigen::VectorXd::Ones(size_);
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

  void finish(const Eigen::VectorXd& z, const Normal& normal, InputStudy::Answer& answer) {
    const double s = scale(normal);
    const Eigen::MatrixXd information = posterior_information(normal), posterior = inverse(information);
    answer.w = z.head(p_);
    answer.rows = normal.rows;
    answer.from_noise = inverse(information.topLeftCorner(p_, p_));
    answer.pose_shift = Eigen::VectorXd::Zero(p_);
    for (const Pose& pose : poses_) {
      answer.pose_shift -= answer.from_noise * information.block(0, pose.first, p_, 6) * z.segment(pose.first, 6);
    }
    answer.from_loads = posterior.topLeftCorner(p_, p_) - answer.from_noise;
    const Eigen::MatrixXd shifts = (posterior * normal.constants / s).topRows(p_);
    answer.from_constants = shifts * shifts.transpose() + scale_shift(shifts, posterior, information);
    if (answer.fitted) {
      each_row(z, true, [&](const Row& row) {
        if (row.modes.size() > 0) answer.test.add(row.error, row.precision, row.modes);
      });
      double fitted = static_cast<double>(p_);
      for (Eigen::Index i = p_; i < size_; ++i) fitted += std::max(0.0, 1.0 - posterior(i, i));
      answer.test.set_fitted(fitted / repeated_);
    }
    tell_inputs(z, posterior, answer);
    correct_loads(Eigen::VectorXd::Zero(size_));
  }

  // Lengths that are all too large by a share: K grows by it, a mass by its cube, the force of a pressure by its square.
  Eigen::MatrixXd scale_shift(const Eigen::MatrixXd& constant_shifts, const Eigen::MatrixXd& posterior,
                              const Eigen::MatrixXd& information) const {
    const double tolerance = base_.settings().mesh.scale_tolerance;
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
      Eigen::VectorXd column = information.col(load.first);
      column[load.first] -= 1.0;  // without the prior
      shift -= 2.0 / load.basis.groups().front().std * (posterior * column).head(p_);
    }
    return tolerance * tolerance * shift * shift.transpose();
  }

  void tell_inputs(const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior, InputStudy::Answer& answer) const {
    for (const Load& load : loads_) {
      const std::string unit = load.basis.components() == 1 ? "Pa" : "N";
      for (const LoadErrorBasis::Group& group : load.basis.groups()) {
        tell(load.topic, group.name, group.unit.empty() ? unit : group.unit, group.std, load.first + group.first,
             group.count, z, posterior, answer);
      }
      answer.corrections[load.topic] = {load.basis, z.segment(load.first, load.basis.size())};
    }
    for (const Pose& pose : poses_) {
      const std::string topic = base_.settings().observations[static_cast<std::size_t>(pose.source)].topic;
      if (pose.offset > 0.0) tell(topic, "pose offset", "m", pose.offset, pose.first, 3, z, posterior, answer);
      if (pose.rotation > 0.0) tell(topic, "pose rotation", "rad", pose.rotation, pose.first + 3, 3, z, posterior, answer);
    }
    for (const UncertainConstant& c : constants_) answer.inputs.push_back({c.name, "value", "", c.std, 0.0, c.std});
  }

  // A group whose estimate is further from zero than its tolerance allows is implausible.
  static void tell(const std::string& input, const std::string& error, const std::string& unit, double std,
                   Eigen::Index first, Eigen::Index count, const Eigen::VectorXd& z, const Eigen::MatrixXd& posterior,
                   InputStudy::Answer& answer) {
    const double n = static_cast<double>(count);
    const double square = z.segment(first, count).squaredNorm();
    const Eigen::VectorXd left = posterior.diagonal().segment(first, count).cwiseMin(1.0);
    const double learnt = (1.0 - left.array()).sum();
    answer.inputs.push_back({input, error, unit, std, std * std::sqrt(square / n), std * std::sqrt(left.mean())});
    const double bound = count > 3 ? learnt + kPlausible * std::sqrt(2.0 * learnt) : kPlausible * kPlausible * learnt;
    if (square <= std::max(bound, 1.0) || !answer.implausible.empty()) return;
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
  double repeated_ = 1.0;
  Eigen::Index p_ = 0, size_ = 0;
  Eigen::VectorXd prior_mean_, prior_information_;
  std::vector<Load> loads_;
  std::vector<Pose> poses_;
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
