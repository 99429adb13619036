#include "forward/linearised_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "fem/products.hpp"
#include "fem/relaxation.hpp"
#include "forward/for_each_index.hpp"
#include "forward/force_change.hpp"
#include "forward/orthogonal_decomposition.hpp"
#include "forward/orthonormal_basis.hpp"
#include "forward/project_matrix.hpp"
#include "forward/static_response.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kMotion = 0.4;       // of the vectors: those of the motion itself
constexpr std::size_t kDeformed = 8;  // instants of which static responses are taken
constexpr double kEnergyLeft = 1e-8;  // share of the energy that vectors may leave out

// Returns the most energetic directions of x in the inner product of K.
Eigen::MatrixXd decompose(const Eigen::MatrixXd& x, const SparseMatrix& k, Eigen::Index most) {
  return most_energetic(x, inner_products(x, symmetric_product(k, x)), kEnergyLeft, most);
}

}  // namespace

std::string why_not_linearised(const ModelPart& part) {
  if (!part.compliant_nodes().empty()) return part.label + " may release nodes";
  if (part.terms.initial_motion) return part.label + " sets the body in motion";
  if (part.effect->contact() != nullptr) return part.label + " touches the body";
  return "";
}

std::string why_not_linearised(const Model& model) {
  if (!model.reactions().empty()) return "reactions to a prescribed motion";
  for (const ModelPart& part : model.parts()) {
    if (std::string why = why_not_linearised(part); !why.empty()) return why;
  }
  return "";
}

/// Finds vectors and sensitivities.
class LinearisedModel::Builder {
 public:
  Builder(LinearisedModel& out, const Eigen::VectorXd& step, const Options& options)
      : out_(out), model_(out.model_), options_(options), unchanged_(out.model_, out.theta_), system_(unchanged_.system) {
    if (!system_.relaxations().empty()) {
      throw InputError(model_.settings().name, "relaxing branches", "a model without them, to be linearised about a run");
    }
    for (Eigen::Index k = 0; k < step.size(); ++k) {
      if (step[k] != 0.0) out_.moved_.push_back(k);
    }
    changes_.resize(out_.moved_.size());
    for_each_index(changes_.size(), [&](std::size_t k) {
      check();
      const Eigen::Index i = out_.moved_[k];
      Eigen::VectorXd moved = out_.theta_;
      moved[i] += step[i];
      changes_[k] = std::make_unique<const ForceChange>(unchanged_, moved, step[i]);
    });
  }

  void build() {
    choose_vectors();
    project_motion();
    project_matrices();
    project_forces();
    integrate();
  }

 private:
  std::size_t instants() const { return out_.run_.size(); }
  auto count() const { return static_cast<Eigen::Index>(changes_.size()); }

  // Takes static responses of the body as it is deformed where it moves farthest, and at instants spread over the run.
  void choose_vectors() {
    const SparseMatrix& mass = system_.mass();
    const SparseMatrix stiffness = model_.rest_stiffness(out_.theta_);
    Eigen::MatrixXd motion(mass.rows(), static_cast<Eigen::Index>(instants()));
    for (std::size_t j = 0; j < instants(); ++j) motion.col(static_cast<Eigen::Index>(j)) = out_.run_[j].displacement;
    Eigen::Index farthest = 0;
    motion.colwise().norm().maxCoeff(&farthest);
    std::vector<std::size_t> deformed{static_cast<std::size_t>(farthest)};
    for (std::size_t i = 1; i < kDeformed; ++i) deformed.push_back(i * (instants() - 1) / (kDeformed - 1));
    std::sort(deformed.begin(), deformed.end());
    deformed.erase(std::unique(deformed.begin(), deformed.end()), deformed.end());
    OrthonormalBasis basis(mass, options_.largest);
    const auto own = static_cast<Eigen::Index>(kMotion * options_.largest);
    basis.add(decompose(motion, stiffness, own), own);
    const Eigen::Index room = (options_.largest - basis.size()) / 2;
    const Eigen::MatrixXd best = decompose(responses(deformed, stiffness), stiffness, room);
    basis.add(best, options_.largest - room);
    const StaticResponse at_rest(stiffness, mass, system_.fixed(), nullptr);
    basis.add(at_rest(symmetric_product(mass, best)), options_.largest);  // what their inertia adds
    out_.vectors_ = basis.vectors();
    weighted_ = basis.weighted();
  }

  // Returns the static responses to all right-hand sides, each for a unit of work.
  Eigen::MatrixXd responses(const std::vector<std::size_t>& deformed, const SparseMatrix& stiffness) const {
    const auto each = static_cast<Eigen::Index>(deformed.size());
    Eigen::MatrixXd forces(stiffness.rows(), count() * each), out(stiffness.rows(), count() * each);
    for_each_index(static_cast<std::size_t>(forces.cols()), [&](std::size_t c) {
      check();
      const DynamicState& at = out_.run_[deformed[c / changes_.size()]];
      forces.col(static_cast<Eigen::Index>(c)) = changes_[c % changes_.size()]->whole(at);
    });
    for (Eigen::Index i = 0; i < forces.rows(); ++i) {
      if (system_.fixed()[static_cast<std::size_t>(i)] != 0) forces.row(i).setZero();
    }
    for_each_index(deformed.size(), [&](std::size_t i) {
      check();
      const Eigen::Index first = count() * static_cast<Eigen::Index>(i);
      out.middleCols(first, count()) = response(out_.run_[deformed[i]], stiffness, forces.middleCols(first, count()));
    });
    for (Eigen::Index c = 0; c < out.cols(); ++c) {
      const double work = out.col(c).dot(forces.col(c));
      out.col(c) *= work > 0.0 ? 1.0 / std::sqrt(work) : 0.0;
    }
    return out;
  }

  // A body that has buckled answers as it does at rest.
  Eigen::MatrixXd response(const DynamicState& at, const SparseMatrix& stiffness, const Eigen::MatrixXd& forces) const {
    try {
      return StaticResponse(system_.stiffness(at.time, at.displacement, at.velocity), system_.mass(), system_.fixed(),
                            nullptr)(forces);
    } catch (const NumericalError&) {
      return StaticResponse(stiffness, system_.mass(), system_.fixed(), nullptr)(forces);
    }
  }

  // Finds the coordinates of the run itself.
  void project_motion() {
    const Eigen::Index m = out_.vectors_.cols(), n = static_cast<Eigen::Index>(instants());
    position_.resize(m, n);
    rate_.resize(m, n);
    acceleration_.resize(m, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const DynamicState& at = out_.run_[static_cast<std::size_t>(j)];
      position_.col(j).noalias() = weighted_.transpose() * at.displacement;
      rate_.col(j).noalias() = weighted_.transpose() * at.velocity;
      acceleration_.col(j).noalias() = weighted_.transpose() * at.acceleration;
    }
    for (std::size_t j = 0; j + 1 < instants(); j += options_.stride) knots_.push_back(j);
    knots_.push_back(instants() - 1);
  }

  void project_matrices() {
    stiffness_.resize(knots_.size());
    damping_.resize(knots_.size());
    const Eigen::MatrixXd& v = out_.vectors_;
    const Eigen::Index m = v.cols();
    const Eigen::MatrixXd damping =
        system_.damped() ? project_matrix(system_.damping(), v) : Eigen::MatrixXd(Eigen::MatrixXd::Zero(m, m));
    for_each_index(knots_.size(), [&](std::size_t j) {
      check();
      const DynamicState& at = out_.run_[knots_[j]];
      stiffness_[j] = project_matrix(system_.stiffness(at.time, at.displacement, at.velocity), v);
      damping_[j] = damping;
      if (system_.has_velocity_tangent())
        damping_[j] += project_matrix(system_.friction(at.time, at.displacement, at.velocity), v);
    });
  }

  void project_forces() {
    forces_.assign(changes_.size(), Eigen::MatrixXd());
    for_each_index(changes_.size(), [&](std::size_t k) {
      check();
      forces_[k] = projected_forces(*changes_[k]);
    });
  }

  // Returns a right-hand side at all instants, m x instants.
  Eigen::MatrixXd projected_forces(const ForceChange& change) const {
    const Eigen::MatrixXd& v = out_.vectors_;
    Eigen::MatrixXd out = (v.transpose() * change.gravity).replicate(1, position_.cols());
    if (change.mass.nonZeros() > 0) out -= project_matrix(change.mass, v) * acceleration_;
    if (change.damping.nonZeros() > 0) out -= project_matrix(change.damping, v) * rate_;
    if (change.stiffness.nonZeros() > 0) out -= project_matrix(change.stiffness, v) * position_;
    for (std::size_t j = 0; j < instants() && change.loads; ++j)
      out.col(static_cast<Eigen::Index>(j)) += v.transpose() * change.load(out_.run_[j].time);
    if (change.relaxes()) add_relaxation(change, out);
    if (change.rates) {
      for (std::size_t j = 0; j < instants(); ++j)
        out.col(static_cast<Eigen::Index>(j)) += v.transpose() * change.nonlinear(out_.run_[j]);
    } else if (change.laws) {
      Eigen::MatrixXd at_knots(out.rows(), static_cast<Eigen::Index>(knots_.size()));
      for (std::size_t j = 0; j < knots_.size(); ++j)
        at_knots.col(static_cast<Eigen::Index>(j)) = v.transpose() * change.nonlinear(out_.run_[knots_[j]]);
      for (std::size_t j = 0; j < instants(); ++j) {
        const Place p = knot(j, 0.0);
        const auto at = static_cast<Eigen::Index>(p.at);
        out.col(static_cast<Eigen::Index>(j)) += (1.0 - p.part) * at_knots.col(at) + p.part * at_knots.col(at + 1);
      }
    }
    return out;
  }
  void add_relaxation(const ForceChange& change, Eigen::MatrixXd& out) const {
    Eigen::VectorXd before = change.strain(out_.run_.front());
    std::vector<Eigen::VectorXd> relaxed(change.branches().size(), before);
    for (std::size_t j = 1; j < instants(); ++j) {
      const DynamicState& at = out_.run_[j];
      const Eigen::VectorXd strain = change.strain(at);
      relax(change.branches(), at.time - out_.run_[j - 1].time, before, strain, relaxed);
      before = strain;
      out.col(static_cast<Eigen::Index>(j)) += out_.vectors_.transpose() * change.relaxation(at, relaxed);
    }
  }

  /// The knot before a place between an instant and the next, and how far it is to the one after.
  Place knot(std::size_t j, double part) const {
    const std::size_t at = std::min(j / options_.stride, knots_.size() - 2);
    return {at, (static_cast<double>(j - knots_[at]) + part) / static_cast<double>(knots_[at + 1] - knots_[at])};
  }

  /// State of all sensitivities.
  struct State {
    Eigen::MatrixXd position, rate, acceleration;  ///< m x moved
  };

  void integrate() {
    const Eigen::Index m = out_.vectors_.cols();
    State s{Eigen::MatrixXd::Zero(m, count()), Eigen::MatrixXd::Zero(m, count()), {}};
    for (Eigen::Index k = 0; k < count(); ++k) {
      s.rate.col(k) =
          weighted_.transpose() * changes_[static_cast<std::size_t>(k)]->velocity.replicate(weighted_.rows() / 3, 1);
    }
    s.acceleration = force(0) - damping_[0] * s.rate;
    out_.sensitivities_.push_back(s.position);
    for (std::size_t j = 0; j + 1 < instants(); ++j) {
      check();
      advance(j, s);
      out_.sensitivities_.push_back(s.position);
    }
  }
  Eigen::MatrixXd force(std::size_t j) const {
    Eigen::MatrixXd out(out_.vectors_.cols(), count());
    for (Eigen::Index k = 0; k < count(); ++k) {
      out.col(k) = forces_[static_cast<std::size_t>(k)].col(static_cast<Eigen::Index>(j));
    }
    return out;
  }

  // A step of generalised-alpha (Chung & Hulbert 1993, eq. 7-19) for matrices at its weighted instant.
  void advance(std::size_t j, State& s) const {
    const AlphaCoefficients c(options_.spectral_radius);
    const double h = out_.run_[j + 1].time - out_.run_[j].time, inside = 1.0 - c.alpha_f;
    const Place p = knot(j, inside);
    const Eigen::MatrixXd k = (1.0 - p.part) * stiffness_[p.at] + p.part * stiffness_[p.at + 1],
                          d = (1.0 - p.part) * damping_[p.at] + p.part * damping_[p.at + 1];
    const Eigen::MatrixXd jacobian = (1.0 - c.alpha_m) * Eigen::MatrixXd::Identity(k.rows(), k.cols()) +
                                     inside * c.gamma * h * d + inside * c.beta * h * h * k;
    const Eigen::MatrixXd known_rate = s.rate + inside * h * (1.0 - c.gamma) * s.acceleration;
    const Eigen::MatrixXd known_position = s.position + inside * (h * s.rate + h * h * (0.5 - c.beta) * s.acceleration);
    const Eigen::MatrixXd now = inside * force(j + 1) + c.alpha_f * force(j);
    const Eigen::MatrixXd next =
        jacobian.partialPivLu().solve(now - c.alpha_m * s.acceleration - d * known_rate - k * known_position);
    s.position += h * s.rate + h * h * ((0.5 - c.beta) * s.acceleration + c.beta * next);
    s.rate += h * ((1.0 - c.gamma) * s.acceleration + c.gamma * next);
    s.acceleration = next;
  }

  void check() const {
    if (options_.checkpoint) options_.checkpoint();
  }

  LinearisedModel& out_;
  const Model& model_;
  const Options& options_;
  const UnchangedForces unchanged_;
  const ModelSystem& system_;
  std::vector<std::unique_ptr<const ForceChange>> changes_;  ///< of each theta that is moved
  std::vector<std::size_t> knots_;                           ///< instants at which matrices and laws are evaluated
  Eigen::MatrixXd weighted_;                                 ///< M times the vectors
  Eigen::MatrixXd position_, rate_, acceleration_;           ///< of the run in the vectors, m x instants
  std::vector<Eigen::MatrixXd> stiffness_, damping_;         ///< in the vectors, at each knot
  std::vector<Eigen::MatrixXd> forces_;                      ///< of each theta that is moved, m x instants
};

LinearisedModel::LinearisedModel(const Model& model, const Eigen::VectorXd& theta, std::vector<DynamicState> run,
                                 const Eigen::VectorXd& step, const Options& options)
    : model_(model), theta_(theta), run_(std::move(run)) {
  if (const std::string why = why_not_linearised(model); !why.empty()) {
    throw InputError(model.settings().name, why, "a model that can be linearised about a run");
  }
  Builder(*this, step, options).build();
  output_.restrict_to(vectors_, std::nullopt);
}

namespace {

class LinearisedTrajectory : public Trajectory {
 public:
  LinearisedTrajectory(const LinearisedModel& model, Eigen::VectorXd theta, double start)
      : model_(model), theta_(std::move(theta)), time_(start) {}

  void advance(double time) override { time_ = std::max(time_, time); }
  double time() const override { return time_; }
  Eigen::VectorXd displacement() const override { return model_.displacement(theta_, time_); }
  Eigen::VectorXd output() const override { return model_.output(theta_, time_); }
  Eigen::VectorXd velocity() const override { return model_.velocity(theta_, time_); }

 private:
  const LinearisedModel& model_;
  Eigen::VectorXd theta_;
  double time_;
};

}  // namespace

std::unique_ptr<Trajectory> LinearisedModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<LinearisedTrajectory>(*this, theta, start);
}

LinearisedModel::Place LinearisedModel::place(double time) const {
  const auto later = [](double t, const DynamicState& state) { return t < state.time; };
  const auto next = std::upper_bound(run_.begin(), run_.end(), time, later);
  if (next == run_.begin()) return {0, 0.0};
  const std::size_t at = std::min(static_cast<std::size_t>(next - run_.begin()) - 1, run_.size() - 2);
  return {at, (time - run_[at].time) / (run_[at + 1].time - run_[at].time)};
}

// The motion between two instants is Hermite's polynomial of third degree, so its slope is the velocity.
Eigen::VectorXd LinearisedModel::motion(const Place& p) const {
  const DynamicState& from = run_[p.at];
  const DynamicState& to = run_[p.at + 1];
  const double h = to.time - from.time, s = p.part, left = 1.0 - s;
  return left * left * (1.0 + 2.0 * s) * from.displacement + s * s * (3.0 - 2.0 * s) * to.displacement +
         h * s * left * (left * from.velocity - s * to.velocity);
}

// Returns the coordinates of what theta changes.
Eigen::VectorXd LinearisedModel::change(const Eigen::VectorXd& theta, const Place& p) const {
  Eigen::VectorXd moves(static_cast<Eigen::Index>(moved_.size()));
  for (Eigen::Index k = 0; k < moves.size(); ++k) {
    const Eigen::Index i = moved_[static_cast<std::size_t>(k)];
    moves[k] = theta[i] - theta_[i];
  }
  return (1.0 - p.part) * (sensitivities_[p.at] * moves) + p.part * (sensitivities_[p.at + 1] * moves);
}

Eigen::VectorXd LinearisedModel::displacement(const Eigen::VectorXd& theta, double time) const {
  const Place p = place(time);
  return motion(p) + vectors_ * change(theta, p);
}

Eigen::VectorXd LinearisedModel::output(const Eigen::VectorXd& theta, double time) const {
  const Place p = place(time);
  Eigen::MatrixXd out = motion(p), moved = Eigen::MatrixXd::Zero(out.rows(), 1);
  output_.displacements(vectors_, change(theta, p), moved);
  return out + moved;
}

// The sensitivities are linear between two instants.
Eigen::VectorXd LinearisedModel::velocity(const Eigen::VectorXd& theta, double time) const {
  const Place p = place(time);
  const DynamicState &from = run_[p.at], &to = run_[p.at + 1];
  const Eigen::VectorXd moved = change(theta, {p.at + 1, 0.0}) - change(theta, {p.at, 0.0});
  return (1.0 - p.part) * from.velocity + p.part * to.velocity + vectors_ * moved / (to.time - from.time);
}

std::string LinearisedModel::description() const {
  return "linearised about a run in full: " + std::to_string(moved_.size()) + " sensitivities in " +
         std::to_string(vectors_.cols()) + " vectors";
}

}  // namespace tissue_stiffness
