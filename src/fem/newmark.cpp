#include "tissue_stiffness/fem/newmark.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMaxIterations = 40;
constexpr int kPatience = 12;     // iterations of a step before the factor is renewed within it
constexpr int kMostRenewals = 6;  // of the factor within a step
constexpr double kGrowth = 2.0;   // of a correction, at which iterations are taken to diverge
constexpr int kYoung = 4;         // steps that a factor's first iterations are counted over
constexpr double kOlder = 0.2;    // share of the last step's acceleration in the first guess
constexpr int kMaxHalvings = 10;
constexpr int kMostCuts = 6;  // of a correction that turns an element inside out
constexpr std::size_t kMostUpdates = 8;
constexpr double kFlat = 1e-8;            // relative curvature below which an update says nothing
constexpr double kSameStep = 0.02;        // relative change of the step that a factor survives
constexpr double kWorthIterations = 0.6;  // iterations that a solution's time buys, with the forces that go with it
constexpr double kMassTolerance = 1e-14;
constexpr Eigen::Index kGrain = 512;  // rows of a product that are worth a task
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void zero_fixed(Eigen::VectorXd& x, const std::vector<char>& fixed) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) x[i] = 0.0;
  }
}

// m x for a symmetric m, rows in parallel.
Eigen::VectorXd product(const SparseMatrix& m, const Eigen::VectorXd& x) {
  Eigen::VectorXd y(x.size());
  tbb::parallel_for(tbb::blocked_range<Eigen::Index>(0, m.outerSize(), kGrain), [&](const auto& part) {
    for (Eigen::Index j = part.begin(); j < part.end(); ++j) {
      double sum = 0.0;
      for (SparseMatrix::InnerIterator entry(m, j); entry; ++entry) sum += entry.value() * x[entry.row()];
      y[j] = sum;
    }
  });
  return y;
}

void turn_nodes(const Eigen::Matrix3Xd& turn, bool back, Eigen::Ref<Eigen::VectorXd> x) {
  for (Eigen::Index i = 0; i < turn.cols(); i += 3) {
    const Eigen::Matrix3d r = turn.middleCols<3>(i);
    const Eigen::Vector3d turned =
        back ? Eigen::Vector3d(r.transpose() * x.segment<3>(i)) : Eigen::Vector3d(r * x.segment<3>(i));
    x.segment<3>(i) = turned;
  }
}

void find_acceleration(const DynamicSystem& system, DynamicState& state) {
  state.relaxed.resize(system.relaxations().size(), state.displacement);
  Eigen::VectorXd f = system.force(state.time, state.displacement, state.velocity);
  if (system.damped()) f -= system.damping() * state.velocity;
  zero_fixed(f, system.fixed());
  SparseMatrix mass = system.mass();
  fix_dofs(mass, system.fixed(), mass.diagonal().mean());
  // A mass matrix is so well conditioned that a few dozen iterations reach round-off.
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver(mass);
  solver.setTolerance(kMassTolerance);
  state.acceleration = solver.solve(f);
}

}  // namespace

const std::vector<Relaxation>& DynamicSystem::relaxations() const {
  static const std::vector<Relaxation> none;
  return none;
}

Newmark::Newmark(std::vector<const DynamicSystem*> systems, double spectral_radius, double tolerance)
    : tolerance_(tolerance) {
  if (spectral_radius < 1.0) {
    alpha_m_ = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
    alpha_f_ = spectral_radius / (spectral_radius + 1.0);
    gamma_ = 0.5 - alpha_m_ + alpha_f_;
    beta_ = 0.25 * std::pow(1.0 - alpha_m_ + alpha_f_, 2);
  }
  columns_.resize(systems.size());
  for (std::size_t i = 0; i < systems.size(); ++i) columns_[i].system = systems[i];
}

Newmark::Newmark(const DynamicSystem& system, double spectral_radius, double tolerance)
    : Newmark(std::vector<const DynamicSystem*>{&system}, spectral_radius, tolerance) {}

void Newmark::initialise(std::vector<DynamicState>& states) const {
  tbb::parallel_for(std::size_t{0}, states.size(),
                    [&](std::size_t i) { find_acceleration(*columns_[i].system, states[i]); });
}

void Newmark::initialise(DynamicState& state) const {
  find_acceleration(*columns_.front().system, state);
}

void Newmark::step(std::vector<DynamicState>& states, const std::vector<double>& steps) {
  cut_step(states, steps, 0);
}

void Newmark::step(DynamicState& state, double step) {
  std::vector<DynamicState> states{state};
  cut_step(states, {step}, 0);
  state = std::move(states.front());
}

void Newmark::cut_step(std::vector<DynamicState>& states, const std::vector<double>& steps, int depth) {
  if (try_step(states, steps)) return;
  if (depth == kMaxHalvings) {
    throw NumericalError("time step at " + std::to_string(states.front().time) + " s diverges, even cut to " +
                         std::to_string(steps.front()) + " s");
  }
  std::vector<DynamicState> half_way = states;
  std::vector<double> half = steps;
  for (double& step : half) step *= 0.5;
  cut_step(half_way, half, depth + 1);
  cut_step(half_way, half, depth + 1);
  states = std::move(half_way);
}

Eigen::VectorXd Newmark::acceleration(const Column& c, const Eigen::VectorXd& x) const {
  const DynamicState& s = *c.before;
  return (x - c.step * s.velocity) / (beta_ * c.step * c.step) - (0.5 / beta_ - 1.0) * s.acceleration;
}

// Residual of the balance at the weighted instants for the displacement increment x.
Eigen::VectorXd Newmark::residual(Column& c, const Eigen::VectorXd& x) const {
  const DynamicState& s = *c.before;
  const DynamicSystem& system = *c.system;
  DynamicState& middle = c.middle;
  const double h = c.step;
  middle.acceleration = acceleration(c, x);
  middle.velocity = s.velocity + (1.0 - alpha_f_) * h * ((1.0 - gamma_) * s.acceleration + gamma_ * middle.acceleration);
  middle.acceleration = (1.0 - alpha_m_) * middle.acceleration + alpha_m_ * s.acceleration;
  middle.time = s.time + (1.0 - alpha_f_) * h;
  middle.displacement = s.displacement + (1.0 - alpha_f_) * x;
  Eigen::VectorXd r = system.force(middle.time, middle.displacement, middle.velocity);
  r -= product(system.mass(), middle.acceleration);
  if (system.damped()) r -= product(system.damping(), middle.velocity);
  if (const auto& branches = system.relaxations(); !branches.empty()) {
    const auto z = relax(branches, (1.0 - alpha_f_) * h, s.displacement, middle.displacement, s.relaxed);
    r -= system.relaxing_stiffness() * overstretch(branches, middle.displacement, z);
  }
  zero_fixed(r, system.fixed());
  return r;
}

void Newmark::factorize(const Column& c) {
  const double h = c.step;
  SparseMatrix j = (1.0 - alpha_f_) * c.system->stiffness(c.middle.time, c.middle.displacement, c.middle.velocity);
  add_scaled(j, (1.0 - alpha_m_) / (beta_ * h * h), c.system->mass());
  if (c.system->damped()) add_scaled(j, (1.0 - alpha_f_) * gamma_ / (beta_ * h), c.system->damping());
  for (const Relaxation& branch : c.system->relaxations()) {
    const double quick = branch.modulus * (1.0 - RelaxationStep(branch, (1.0 - alpha_f_) * h).to);
    add_scaled(j, (1.0 - alpha_f_) * quick, c.system->relaxing_stiffness());
  }
  fix_dofs(j, c.system->fixed(), j.diagonal().mean());
  solver_.factorize(j);
  for (Column& column : columns_) {
    column.updates.clear();
    column.last = kInfinity;
  }
  factored_rotations_ = c.system->rotations(c.middle.displacement);
  turn_ = {};
  factored_step_ = h;
  young_before_ = young_;
  young_ = excess_ = 0.0;
  steps_ = 0;
  ++factorisations_;
}

// The factor's stiffness turns with the material.
void Newmark::turn() {
  const Column& c = columns_.front();
  turn_ = c.system->rotations(c.middle.displacement);
  for (Eigen::Index i = 0; i < turn_.cols(); i += 3) {
    const Eigen::Matrix3d now = turn_.middleCols<3>(i);
    turn_.middleCols<3>(i) = now * factored_rotations_.middleCols<3>(i).transpose();
  }
}

// From what displacement, velocity and acceleration promise. The acceleration rings in modes that the steps do not resolve:
// with a part of the one before it promises better.
bool Newmark::start() {
  std::vector<char> fine(columns_.size(), 1);
  tbb::parallel_for(std::size_t{0}, columns_.size(), [&](std::size_t i) {
    Column& c = columns_[i];
    const DynamicState& s = *c.before;
    c.increment = c.step * s.velocity + 0.5 * c.step * c.step * s.acceleration;
    if (c.reached == s.time) c.increment -= 0.5 * kOlder * c.step * c.step * (s.acceleration - c.earlier_acceleration);
    c.last = kInfinity;
    c.rate = 1.0;
    c.done = false;
    c.updates.clear();
    try {
      c.residual = residual(c, c.increment);
    } catch (const NumericalError&) {
      fine[i] = 0;
    }
  });
  return std::all_of(fine.begin(), fine.end(), [](char flag) { return flag != 0; });
}

// The two-loop recursion of L-BFGS (Nocedal & Wright 2006, alg. 7.4) around the factored Jacobian.
void Newmark::find_directions(const std::vector<Column*>& active) {
  std::vector<std::vector<double>> weights(active.size());
  Eigen::MatrixXd q(active.front()->residual.size(), static_cast<Eigen::Index>(active.size()));
  tbb::parallel_for(std::size_t{0}, active.size(), [&](std::size_t k) {
    const Column& c = *active[k];
    auto qk = q.col(static_cast<Eigen::Index>(k));
    qk = c.residual;
    weights[k].resize(c.updates.size());
    for (std::size_t i = c.updates.size(); i-- > 0;) {
      weights[k][i] = c.updates[i]->inverse_curvature * c.updates[i]->step.dot(qk);
      qk -= weights[k][i] * c.updates[i]->change;
    }
    turn_nodes(turn_, true, qk);
  });
  const Eigen::MatrixXd d = solver_.solve_roughly(q);
  tbb::parallel_for(std::size_t{0}, active.size(), [&](std::size_t k) {
    Column& c = *active[k];
    c.direction = d.col(static_cast<Eigen::Index>(k));
    turn_nodes(turn_, false, c.direction);
    for (std::size_t i = 0; i < c.updates.size(); ++i) {
      const Update& u = *c.updates[i];
      c.direction += (weights[k][i] - u.inverse_curvature * u.change.dot(c.direction)) * u.step;
    }
  });
}

// Ends the columns whose next correction would be below the tolerance, as far as the last two tell.
Newmark::Progress Newmark::judge(const std::vector<Column*>& active, int iteration) const {
  bool all = true, slow = iteration >= kPatience;
  for (Column* column : active) {
    Column& c = *column;
    const double size = c.direction.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return Progress::failed;
    slow = slow || size > kGrowth * c.last;
    if (std::isfinite(c.last)) c.rate = std::min(1.0, size / c.last);
    c.done = size * c.rate < tolerance_;
    if (c.done) c.increment += c.direction;
    c.last = size;
    all = all && c.done;
  }
  return all ? Progress::done : slow ? Progress::slow : Progress::going;
}

// Takes the corrections, shortened where they turn an element inside out.
bool Newmark::move(const std::vector<Column*>& active) const {
  std::vector<char> fine(active.size(), 1);
  tbb::parallel_for(std::size_t{0}, active.size(), [&](std::size_t i) {
    Column& c = *active[i];
    if (c.done) return;
    for (int cut = 0;; ++cut) {
      try {
        c.next = residual(c, c.increment + c.direction);
        break;
      } catch (const NumericalError&) {
        if (cut == kMostCuts) {
          fine[i] = 0;
          return;
        }
        c.direction *= 0.5;
      }
    }
    c.increment += c.direction;
    learn(c);
  });
  return std::all_of(fine.begin(), fine.end(), [](char flag) { return flag != 0; });
}

void Newmark::learn(Column& c) {
  c.residual -= c.next;  // the change
  const double curvature = c.direction.dot(c.residual);
  if (curvature > kFlat * c.direction.norm() * c.residual.norm()) {
    auto update = std::make_shared<Update>();
    update->step.swap(c.direction);
    update->change.swap(c.residual);
    update->inverse_curvature = 1.0 / curvature;
    if (c.updates.size() == kMostUpdates) c.updates.pop_front();
    c.updates.push_back(std::move(update));
  }
  c.residual.swap(c.next);
}

int Newmark::iterate() {
  int renewals = 0;
  for (int k = 0, since = 0; k < kMaxIterations; ++k, ++since) {
    ++iterations_;
    std::vector<Column*> active;
    for (Column& column : columns_) {
      if (!column.done) active.push_back(&column);
    }
    find_directions(active);
    const Progress progress = judge(active, since);
    if (progress == Progress::done) return k + 1;
    if (progress == Progress::failed) return 0;
    if (progress == Progress::slow) {  // the factor is too old here: renew it and take this iteration again
      if (++renewals > kMostRenewals) return 0;
      factorize(*active.front());
      since = -1;
    } else if (!move(active)) {
      return 0;
    }
  }
  return 0;
}

bool Newmark::try_step(std::vector<DynamicState>& states, const std::vector<double>& steps) {
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    columns_[i].before = &states[i];
    columns_[i].step = steps[i];
  }
  try {
    if (!start()) return false;
    const bool other_step = std::abs(steps.front() - factored_step_) > kSameStep * factored_step_;
    if (!solver_.ready() || other_step || excess_ > kWorthIterations * worth_ * solver_.cost()) {
      factorize(columns_.front());
    } else {
      turn();
    }
    const int iterations = iterate();
    if (iterations == 0) return false;
    note_age(iterations);
  } catch (const NumericalError&) {
    return false;
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) accept(columns_[i], states[i]);
  return true;
}

// What a factor's age costs is counted against its own first steps; renewals that did not help make the next one dearer.
void Newmark::note_age(int iterations) {
  if (++steps_ <= kYoung) {
    young_ += static_cast<double>(iterations) / kYoung;
    if (steps_ == kYoung && young_before_ > 0.0) worth_ = young_ > young_before_ ? 2.0 * worth_ : 1.0;
    return;
  }
  excess_ = std::max(0.0, excess_ + iterations - young_);
}

void Newmark::accept(Column& c, DynamicState& state) const {
  const Eigen::VectorXd a = acceleration(c, c.increment);
  state.velocity += c.step * ((1.0 - gamma_) * state.acceleration + gamma_ * a);
  state.relaxed =
      relax(c.system->relaxations(), c.step, state.displacement, state.displacement + c.increment, state.relaxed);
  state.displacement += c.increment;
  c.earlier_acceleration = std::exchange(state.acceleration, a);
  state.time += c.step;
  c.reached = state.time;
}

}  // namespace tissue_stiffness
