#include "diagnosis/force_smoother.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kLevels[] = {1.0, 0.3, 0.1, 0.03, 0.01};  // of the forces that move the modes
constexpr double kWalks[] = {0.0, 0.03, 0.1, 0.3, 1.0};    // of the level: size of the step from frame to frame
constexpr double kModeLikelier = 10.0;                     // fall of the deviance that the force on a mode must bring
constexpr std::pair<double, double> kNoChange{1, 1};
// These are factors on the common level and on its step, for each mode on its own.
constexpr std::pair<double, double> kOwn[] = {{0, 0}, {0.3, 0.3}, {3, 3}, {1, 0}, {1, 0.1}, {1, 0.3}, {1, 3}, {1, 10}};

// Their sizes have an upper bound, so that the filter allocates nothing in its loop over frames.
template <int most_rows, int most_columns>
using Bounded = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, most_rows, most_columns>;
using State = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 3 * most_force_modes, 1>;
using Covariance = Bounded<3 * most_force_modes, 3 * most_force_modes>;
using Square = Bounded<most_force_modes, most_force_modes>;
using Wide = Bounded<most_force_modes, 3 * most_force_modes>;

/// Returns the state, x = (q, v, f), after a transition.
template <class Matrix>
Matrix after(const ModalTransition& t, const Matrix& x) {
  const Eigen::Index m = t.qq.size();
  const auto q = x.topRows(m).array(), v = x.middleRows(m, m).array(), f = x.bottomRows(m).array();
  Matrix out(x.rows(), x.cols());
  out.topRows(m) = (q.colwise() * t.qq + v.colwise() * t.qv + f.colwise() * t.qf).matrix();
  out.middleRows(m, m) = (q.colwise() * t.vq + v.colwise() * t.vv + f.colwise() * t.vf).matrix();
  out.bottomRows(m) = f.matrix();
  return out;
}

/// Applies the transposed transition: it turns what weighs on the state after a transition into what weighs on the state
/// before.
Eigen::VectorXd before(const ModalTransition& t, const Eigen::VectorXd& r) {
  const Eigen::Index m = t.qq.size();
  const auto q = r.head(m).array(), v = r.segment(m, m).array(), f = r.tail(m).array();
  Eigen::VectorXd out(r.size());
  out << (t.qq * q + t.vq * v).matrix(), (t.qv * q + t.vv * v).matrix(), (t.qf * q + t.vf * v + f).matrix();
  return out;
}

/// Returns each frame's L with information = L L^T.
std::vector<Square> roots_of(const std::vector<FrameEvidence>& evidence) {
  std::vector<Square> out;
  out.reserve(evidence.size());
  for (const FrameEvidence& frame : evidence) {
    const Eigen::LDLT<Eigen::MatrixXd> factor(frame.information);
    const Eigen::MatrixXd l = factor.matrixL();
    out.emplace_back(factor.transpositionsP().transpose() *
                     (l * factor.vectorD().cwiseMax(0.0).cwiseSqrt().asDiagonal()).eval());
  }
  return out;
}

/// It holds the state before a frame's evidence, and what that evidence does to it.
struct Passed {
  Eigen::VectorXd x;
  Eigen::MatrixXd p;
  Eigen::VectorXd pull;   ///< state after the evidence: x + P (pull, 0, 0)
  Eigen::MatrixXd grasp;  ///< covariance after it: P - P (grasp, 0; 0, 0) P
};

/// Filters all frames and returns the deviance. What happens at each frame is added to `passed`, where it is not null.
double filter_force(const std::vector<ModalTransition>& transitions, const std::vector<FrameEvidence>& evidence,
                    const std::vector<Square>& roots, const ForcePrior& prior, std::vector<Passed>* passed = nullptr) {
  const Eigen::Index m = prior.level.size(), size = 3 * m;
  State x = State::Zero(size);
  Covariance p = Covariance::Zero(size, size);
  p.diagonal().tail(m) = prior.level.cwiseAbs2();
  Eigen::LLT<Square> factor(m);
  Wide y(m, size);
  double deviance = 0.0;
  for (std::size_t k = 0; k < evidence.size(); ++k) {
    const Square& l = roots[k];
    x = after(transitions[k], x);
    p = after<Covariance>(transitions[k], after(transitions[k], p).transpose());
    p.diagonal().tail(m) += prior.walk.cwiseAbs2();
    // The information is L L^T, so the gain needs no more than I + L^T P L = C C^T. The covariance falls by y^T y.
    y.noalias() = l.transpose() * p.topRows(m);
    Square inner = Square::Identity(m, m);
    inner.noalias() += y.leftCols(m) * l;
    factor.compute(inner);
    const State q = x.head(m);
    const State innovation = evidence[k].seen - evidence[k].information * q;
    const State explained = factor.solve(y.leftCols(m) * innovation);
    const State pull = innovation - l * explained;
    const State step = p.leftCols(m) * pull;
    deviance += evidence[k].square - 2.0 * evidence[k].seen.dot(q) + q.dot(evidence[k].information * q) -
                innovation.dot(step.head(m)) + 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    if (passed) passed->push_back({x, p, pull, l * factor.solve(l.transpose())});
    x += step;
    factor.matrixL().solveInPlace(y);
    p.noalias() -= y.transpose() * y;
  }
  return deviance;
}

}  // namespace

ModalTransition::ModalTransition(ModalStep step, double span, Eigen::Index modes, Eigen::Index all) {
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(all), one = Eigen::VectorXd::Ones(all);
  const auto respond = [&](int unit, const Eigen::VectorXd& force, Eigen::ArrayXd& q, Eigen::ArrayXd& v) {
    Eigen::MatrixXd state = Eigen::MatrixXd::Zero(all, step.states());
    if (unit >= 0) state.col(unit).setOnes();
    step.advance(span, force, force, state);
    q = state.col(0).head(modes).array();
    v = state.col(1).head(modes).array();
  };
  respond(0, none, qq, vq);
  respond(1, none, qv, vv);
  respond(-1, one, qf, vf);
}

SmoothedForce smooth_force(const std::vector<ModalTransition>& transitions, const std::vector<FrameEvidence>& evidence,
                           const ForcePrior& prior) {
  std::vector<Passed> passed;
  const Eigen::Index m = prior.level.size();
  SmoothedForce out;
  out.deviance = filter_force(transitions, evidence, roots_of(evidence), prior, &passed);
  // This does without the covariances' inverses: those of forces that never change have none.
  Eigen::VectorXd r = Eigen::VectorXd::Zero(3 * m);
  out.displacement.resize(passed.size());
  out.force.resize(passed.size());
  for (std::size_t k = passed.size(); k-- > 0;) {
    if (k + 1 < passed.size()) r = before(transitions[k + 1], r);
    r.head(m) += passed[k].pull - passed[k].grasp * (passed[k].p.topRows(m) * r);
    const Eigen::VectorXd state = passed[k].x + passed[k].p * r;
    out.displacement[k] = state.head(m);
    out.force[k] = state.tail(m);
  }
  return out;
}

ForcePrior likeliest_force_prior(const std::vector<ModalTransition>& transitions,
                                 const std::vector<FrameEvidence>& evidence, double scale) {
  const Eigen::Index m = evidence.front().seen.size();
  const std::vector<Square> roots = roots_of(evidence);
  const auto deviances = [&](const std::vector<ForcePrior>& priors) {
    std::vector<double> out(priors.size());
    for_each_index(priors.size(), [&](std::size_t i) { out[i] = filter_force(transitions, evidence, roots, priors[i]); });
    return out;
  };
  std::vector<ForcePrior> common, own;
  for (const double level : kLevels) {
    for (const double walk : kWalks)
      common.push_back({Eigen::VectorXd::Constant(m, level * scale), Eigen::VectorXd::Constant(m, walk * level * scale)});
  }
  std::vector<double> deviance = deviances(common);
  const auto lowest = std::min_element(deviance.begin(), deviance.end());
  ForcePrior best = common[static_cast<std::size_t>(lowest - deviance.begin())];
  const double reference = *lowest;
  for (Eigen::Index i = 0; i < m; ++i) {
    for (const auto& [level, walk] : kOwn) {
      own.push_back(best);
      own.back().level[i] *= level;
      own.back().walk[i] *= walk;
    }
  }
  deviance = deviances(own);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto from = deviance.begin() + i * static_cast<std::ptrdiff_t>(std::size(kOwn));
    const auto likelier = std::min_element(from, from + static_cast<std::ptrdiff_t>(std::size(kOwn)));
    const bool needed = *from > std::min(reference, *likelier) + kModeLikelier;
    const auto& [level, walk] = needed && *likelier > reference ? kNoChange : kOwn[needed ? likelier - from : 0];
    best.level[i] *= level;
    best.walk[i] *= walk;
  }
  return best;
}

double log_of_tried_priors(Eigen::Index modes) {
  return std::log(static_cast<double>(std::size(kLevels) * std::size(kWalks))) +
         static_cast<double>(modes) * std::log(static_cast<double>(std::size(kOwn)));
}

}  // namespace tissue_stiffness
