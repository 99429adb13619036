#include "fem/generalized_alpha.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/LU>
#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "fem/products.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kMaxIterations = 40;
constexpr int kPatience = 12;     // iterations of a step before the factor is renewed within it
constexpr int kMostRenewals = 6;  // of the factor within a step
constexpr double kGrowth = 2.0;   // of a correction, at which iterations are taken to diverge
constexpr int kYoung = 4;         // steps that a factor's first iterations are counted over
constexpr int kMaxHalvings = 10;
constexpr int kMostCuts = 6;              // of a correction that turns an element inside out
constexpr double kSameStep = 0.02;        // relative change of the step that a factor survives
constexpr double kWorthIterations = 0.6;  // iterations that a solution's time buys, with the forces that go with it
constexpr double kMassTolerance = 1e-14;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

void zero_fixed(Eigen::VectorXd& x, const std::vector<char>& fixed) {
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    if (fixed[static_cast<std::size_t>(i)] != 0) x[i] = 0.0;
  }
}

// Multiplies each node's part of x by its matrix, or by the transposed one.
void multiply_nodes(const Eigen::Matrix3Xd& matrices, bool transposed, Eigen::Ref<Eigen::VectorXd> x) {
  for (Eigen::Index i = 0; i < matrices.cols(); i += 3) {
    const Eigen::Matrix3d m = matrices.middleCols<3>(i);
    const Eigen::Vector3d product =
        transposed ? Eigen::Vector3d(m.transpose() * x.segment<3>(i)) : Eigen::Vector3d(m * x.segment<3>(i));
    x.segment<3>(i) = product;
  }
}

void initialise_one(const DynamicSystem& system, DynamicState& state) {
  start_relaxed(system, state);
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

Eigen::VectorXd DynamicSystem::force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Eigen::VectorXd f = Eigen::VectorXd::Zero(u.size());
  add_force(time, u, v, f);
  return f;
}

void DynamicSystem::subtract_relaxing_force(const Eigen::VectorXd&, const Eigen::VectorXd& stretch,
                                            Eigen::VectorXd& f) const {
  subtract_product(relaxing_stiffness(), stretch, f);
}

void start_relaxed(const DynamicSystem& system, DynamicState& state) {
  if (state.relaxed.size() >= system.relaxations().size()) return state.relaxed.resize(system.relaxations().size());
  Eigen::VectorXd strain;
  system.find_relaxing_strain(state.displacement, strain);
  state.relaxed.resize(system.relaxations().size(), strain);
}

const std::vector<Relaxation>& DynamicSystem::relaxations() const {
  static const std::vector<Relaxation> none;
  return none;
}

AlphaCoefficients::AlphaCoefficients(double spectral_radius) {
  if (spectral_radius >= 1.0) return;
  alpha_m = (2.0 * spectral_radius - 1.0) / (spectral_radius + 1.0);
  alpha_f = spectral_radius / (spectral_radius + 1.0);
  gamma = 0.5 - alpha_m + alpha_f;
  beta = 0.25 * std::pow(1.0 - alpha_m + alpha_f, 2);
}

GeneralizedAlpha::GeneralizedAlpha(std::vector<const DynamicSystem*> systems, double spectral_radius, double tolerance)
    : alpha_(spectral_radius), tolerance_(tolerance) {
  columns_.resize(systems.size());
  for (std::size_t i = 0; i < systems.size(); ++i) columns_[i].system = systems[i];
}

GeneralizedAlpha::GeneralizedAlpha(const DynamicSystem& system, double spectral_radius, double tolerance)
    : GeneralizedAlpha(std::vector<const DynamicSystem*>{&system}, spectral_radius, tolerance) {}

void GeneralizedAlpha::initialise(std::vector<DynamicState>& states) const {
  tbb::parallel_for(std::size_t{0}, states.size(), [&](std::size_t i) { initialise_one(*columns_[i].system, states[i]); });
}

void GeneralizedAlpha::initialise(DynamicState& state) const {
  initialise_one(*columns_.front().system, state);
}

void GeneralizedAlpha::step(std::vector<DynamicState>& states, const std::vector<double>& steps) {
  cut_step(states, steps, 0);
}

void GeneralizedAlpha::step(DynamicState& state, double step) {
  std::vector<DynamicState> states{state};
  cut_step(states, {step}, 0);
  state = std::move(states.front());
}

void GeneralizedAlpha::cut_step(std::vector<DynamicState>& states, const std::vector<double>& steps, int depth) {
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

void GeneralizedAlpha::find_acceleration(const Column& c, const Eigen::VectorXd& x, Eigen::VectorXd& a) const {
  const DynamicState& s = *c.before;
  a = (x - c.step * s.velocity) / (alpha_.beta * c.step * c.step) - (0.5 / alpha_.beta - 1.0) * s.acceleration;
}

// Computes the residual of the balance at the weighted instants for the displacement increment x.
void GeneralizedAlpha::find_residual(Column& c, const Eigen::VectorXd& x, Eigen::VectorXd& r) const {
  const DynamicState& s = *c.before;
  const DynamicSystem& system = *c.system;
  DynamicState& middle = c.middle;
  const double h = c.step;
  find_acceleration(c, x, middle.acceleration);
  middle.velocity = s.velocity + (1.0 - alpha_.alpha_f) * h *
                                     ((1.0 - alpha_.gamma) * s.acceleration + alpha_.gamma * middle.acceleration);
  middle.acceleration = (1.0 - alpha_.alpha_m) * middle.acceleration + alpha_.alpha_m * s.acceleration;
  middle.time = s.time + (1.0 - alpha_.alpha_f) * h;
  middle.displacement = s.displacement + (1.0 - alpha_.alpha_f) * x;
  r.setZero(x.size());
  system.add_force(middle.time, middle.displacement, middle.velocity, r);
  subtract_product(system.mass(), middle.acceleration, r);
  if (system.damped()) subtract_product(system.damping(), middle.velocity, r);
  if (const auto& branches = system.relaxations(); !branches.empty()) {
    middle.relaxed = s.relaxed;
    system.find_relaxing_strain(middle.displacement, c.strain);
    relax(branches, (1.0 - alpha_.alpha_f) * h, c.strain_before, c.strain, middle.relaxed);
    overstretch(branches, c.strain, middle.relaxed, c.stretch);
    system.subtract_relaxing_force(middle.displacement, c.stretch, r);
  }
  zero_fixed(r, system.fixed());
}

void GeneralizedAlpha::factorize(const Column& c) {
  const double h = c.step;
  SparseMatrix j = c.system->stiffness(c.middle.time, c.middle.displacement, c.middle.velocity);
  j *= 1.0 - alpha_.alpha_f;
  add_scaled(j, (1.0 - alpha_.alpha_m) / (alpha_.beta * h * h), c.system->mass());
  const double to_velocity = (1.0 - alpha_.alpha_f) * alpha_.gamma / (alpha_.beta * h);
  if (c.system->damped()) add_scaled(j, to_velocity, c.system->damping());
  if (c.system->has_velocity_tangent()) {
    add_scaled(j, to_velocity, c.system->friction(c.middle.time, c.middle.displacement, c.middle.velocity));
  }
  for (const Relaxation& branch : c.system->relaxations()) {
    const double quick = branch.modulus * (1.0 - RelaxationStep(branch, (1.0 - alpha_.alpha_f) * h).to);
    add_scaled(j, (1.0 - alpha_.alpha_f) * quick, c.system->relaxing_stiffness());
  }
  fix_dofs(j, c.system->fixed(), j.diagonal().mean());
  solver_.factorize(j);
  for (Column& column : columns_) {
    column.updates.clear();
    column.last = kInfinity;
  }
  c.system->find_deformation(c.middle.displacement, factored_inverse_);
  for (Eigen::Index i = 0; i < factored_inverse_.cols(); i += 3) {
    factored_inverse_.middleCols<3>(i) = factored_inverse_.middleCols<3>(i).inverse().eval();
  }
  push_forward();
  factored_step_ = h;
  young_before_ = young_;
  young_ = excess_ = 0.0;
  steps_ = 0;
  ++factorisations_;
}

// Finds each column's deformation since the factor was made, because the factor's stiffness moves with the material.
void GeneralizedAlpha::push_forward() {
  tbb::parallel_for(std::size_t{0}, columns_.size(), [&](std::size_t k) {
    Column& c = columns_[k];
    if (c.done) return;
    c.system->find_deformation(c.middle.displacement, c.deformation);
    for (Eigen::Index i = 0; i < c.deformation.cols(); i += 3) {
      c.deformation.middleCols<3>(i) *= factored_inverse_.middleCols<3>(i);
    }
  });
}

// Extrapolates the mean velocities of the last two steps. They hold nothing of the accelerations of modes that the steps
// do not resolve, which oscillate, or which a sudden load starts with. The first steps keep the velocity.
bool GeneralizedAlpha::start() {
  std::atomic<bool> fine{true};
  tbb::parallel_for(std::size_t{0}, columns_.size(), [&](std::size_t i) {
    Column& c = columns_[i];
    const DynamicState& s = *c.before;
    if (c.reached != s.time) c.last_step = c.earlier_step = 0.0;
    if (c.earlier_step > 0.0) {
      const double trend = (c.last_step + c.step) / (c.last_step + c.earlier_step);
      c.increment =
          (1.0 + trend) * c.step / c.last_step * c.last_increment - trend * c.step / c.earlier_step * c.earlier_increment;
    } else {
      c.increment = c.step * s.velocity;
    }
    c.last = kInfinity;
    c.rate = 1.0;
    c.done = false;
    c.updates.clear();
    if (!c.system->relaxations().empty()) c.system->find_relaxing_strain(s.displacement, c.strain_before);
    try {
      find_residual(c, c.increment, c.residual);
    } catch (const NumericalError&) {
      fine = false;
    }
  });
  return fine;
}

void GeneralizedAlpha::find_directions() {
  directions_.resize(active_.front()->residual.size(), static_cast<Eigen::Index>(columns_.size()));
  tbb::parallel_for(std::size_t{0}, active_.size(), [&](std::size_t k) {
    auto d = directions_.col(static_cast<Eigen::Index>(k));
    d = active_[k]->residual;
    active_[k]->updates.before(d);
    multiply_nodes(active_[k]->deformation, true, d);
  });
  solver_.solve_roughly_in_place(directions_.leftCols(static_cast<Eigen::Index>(active_.size())));
  tbb::parallel_for(std::size_t{0}, active_.size(), [&](std::size_t k) {
    Column& c = *active_[k];
    c.direction = directions_.col(static_cast<Eigen::Index>(k));
    multiply_nodes(c.deformation, false, c.direction);
    c.updates.after(c.direction);
  });
}

// Ends the columns whose next correction would be below the tolerance, judging from the last two.
GeneralizedAlpha::Progress GeneralizedAlpha::judge(int iteration) {
  bool all = true, slow = iteration >= kPatience;
  for (Column* column : active_) {
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

bool GeneralizedAlpha::move() {
  std::atomic<bool> fine{true};
  tbb::parallel_for(std::size_t{0}, active_.size(), [&](std::size_t i) {
    if (!active_[i]->done && !move(*active_[i])) fine = false;
  });
  return fine;
}

// Applies the correction, and halves it while it turns an element inside out.
bool GeneralizedAlpha::move(Column& c) const {
  for (int cut = 0;; ++cut, c.direction *= 0.5) {
    c.next_increment = c.increment + c.direction;
    try {
      find_residual(c, c.next_increment, c.next_residual);
      break;
    } catch (const NumericalError&) {
      if (cut == kMostCuts) return false;
    }
  }
  c.increment.swap(c.next_increment);
  c.residual -= c.next_residual;  // the change
  c.updates.learn(c.direction, c.residual);
  c.residual.swap(c.next_residual);
  return true;
}

int GeneralizedAlpha::iterate() {
  int renewals = 0;
  for (int k = 0, since = 0; k < kMaxIterations; ++k, ++since) {
    ++iterations_;
    active_.clear();
    for (Column& column : columns_) {
      if (!column.done) active_.push_back(&column);
    }
    find_directions();
    const Progress progress = judge(since);
    if (progress == Progress::done) return k + 1;
    if (progress == Progress::failed) return 0;
    if (progress == Progress::slow) {  // the factor is too old here: renew it and take this iteration again
      if (++renewals > kMostRenewals) return 0;
      factorize(*active_.front());
      since = -1;
    } else if (!move()) {
      return 0;
    }
  }
  return 0;
}

bool GeneralizedAlpha::try_step(std::vector<DynamicState>& states, const std::vector<double>& steps) {
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
      push_forward();
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

// The cost of a factor's age is counted relative to its own first steps. Renewals that did not help make the next one more
// expensive.
void GeneralizedAlpha::note_age(int iterations) {
  if (++steps_ <= kYoung) {
    young_ += static_cast<double>(iterations) / kYoung;
    if (steps_ == kYoung && young_before_ > 0.0) worth_ = young_ > young_before_ ? 2.0 * worth_ : 1.0;
    return;
  }
  excess_ = std::max(0.0, excess_ + iterations - young_);
}

void GeneralizedAlpha::accept(Column& c, DynamicState& state) const {
  Eigen::VectorXd &a = c.middle.acceleration, &u = c.middle.displacement;
  find_acceleration(c, c.increment, a);
  u = state.displacement + c.increment;
  state.velocity += c.step * ((1.0 - alpha_.gamma) * state.acceleration + alpha_.gamma * a);
  if (const auto& branches = c.system->relaxations(); !branches.empty()) {
    c.system->find_relaxing_strain(u, c.strain);
    relax(branches, c.step, c.strain_before, c.strain, state.relaxed);
  }
  state.displacement.swap(u);
  state.acceleration.swap(a);
  c.earlier_increment.swap(c.last_increment);
  c.last_increment.swap(c.increment);
  c.earlier_step = std::exchange(c.last_step, c.step);
  state.time += c.step;
  c.reached = state.time;
}

}  // namespace tissue_stiffness
