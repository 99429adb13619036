#include "forward/full_model.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "fem/central_difference.hpp"
#include "fem/products.hpp"
#include "fem/strain.hpp"
#include "forward/for_each_index.hpp"
#include "forward/reduced_model.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kForReactions = 1e-5;     // of the tolerance
constexpr double kCompressible = 9.0;      // lambda / mu of a Poisson's ratio of 0.45
constexpr double kMostForReactions = 0.9;  // spectral radius
constexpr double kMostForTools = 0.3;      // likewise
constexpr double kExplicitSteps =
    250;  // explicit steps that one call of advance() may take before implicit ones are cheaper

// Returns the largest error of a displacement [m]. The springs of a moved region turn it into an error of its reaction. In
// nearly incompressible tissue it becomes an error of the pressure, lambda / mu times that of the shear stress. Such a
// pressure rings from step to step, and makes the tangent indefinite where it reaches mu.
double tolerance_of(const Model& model, const ModelSystem& system, double share) {
  if (!model.reactions().empty()) share *= kForReactions;
  if (model.may_be_finite()) share /= std::max(1.0, system.largest_lame_ratio() / kCompressible);
  return share * body_size(model.mesh().nodes);
}

DynamicState at_start(const Model& model, const Eigen::VectorXd& theta, double start, const ReducedModel* linear_form) {
  const Eigen::Index n = model.fem().dof_count();
  DynamicState state;
  state.time = start;
  state.displacement = Eigen::VectorXd::Zero(n);
  state.velocity = model.initial_velocity(theta).replicate(n / 3, 1);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (model.fixed()[static_cast<std::size_t>(i)] != 0) state.velocity[i] = 0.0;
  }
  if (linear_form != nullptr) {
    const auto run = linear_form->start(theta, start);
    state.displacement = run->displacement();
    state.velocity = run->velocity();
  }
  return state;
}

// What rings in the springs of a moved region has to decay, and sooner what a tool's contact makes ring.
double radius_of(const Model& model, double wanted) {
  for (const Model::Reaction& reaction : model.reactions()) {
    const bool tool = model.parts()[reaction.part].effect->contact() != nullptr;
    wanted = std::min(wanted, tool ? kMostForTools : kMostForReactions);
  }
  return wanted;
}

class FullTrajectories : public Trajectories {
 public:
  FullTrajectories(const Model& model, const std::vector<Eigen::VectorXd>& thetas, std::vector<DynamicState> states,
                   const FullModel::Options& options)
      : options_(options),
        systems_(make_systems(model, thetas)),
        stepper_(views(systems_), radius_of(model, options.spectral_radius),
                 tolerance_of(model, *systems_.front(), options.tolerance)),
        states_(std::move(states)),
        reactions_(states_.size(), Eigen::MatrixXd(model.output_size() - model.fem().dof_count(), 2)) {}

  std::size_t size() const override { return states_.size(); }
  void advance(const std::vector<double>& times) override {
    std::vector<double> spans;
    for (std::size_t i = 0; i < times.size(); ++i) spans.push_back(times[i] - states_[i].time);
    if (!(*std::min_element(spans.begin(), spans.end()) > 0.0)) return;
    if (!chosen_) choose(spans);
    explicit_steps_ ? leap(spans) : implicit(spans);
    for (std::size_t i = 0; i < times.size(); ++i) states_[i].time = times[i];
  }
  void outputs(Eigen::MatrixXd& out) const override {
    for (std::size_t i = 0; i < states_.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = output(i);
  }
  Eigen::VectorXd output(std::size_t i) const {
    Eigen::VectorXd out(states_[i].displacement.size() + reactions_[i].rows());
    out << states_[i].displacement, reactions(i);
    return out;
  }
  void combine(const Eigen::VectorXd& weights, Eigen::Ref<Eigen::VectorXd> sum) const override {
    const auto displacement = [this](std::size_t i) -> const Eigen::VectorXd& { return states_[i].displacement; };
    add_weighted(weights, displacement, sum);
  }
  const DynamicState& state(std::size_t i) const { return states_[i]; }

 private:
  using Systems = std::vector<std::unique_ptr<const ModelSystem>>;
  static Systems make_systems(const Model& model, const std::vector<Eigen::VectorXd>& thetas) {
    Systems systems(thetas.size());
    for_each_index(thetas.size(), [&](std::size_t i) { systems[i] = std::make_unique<ModelSystem>(model, thetas[i]); });
    return systems;
  }
  static std::vector<const DynamicSystem*> views(const Systems& systems) {
    std::vector<const DynamicSystem*> list;
    for (const auto& system : systems) list.push_back(system.get());
    return list;
  }

  // Impacts are filmed so fast that a few explicit steps reach the next frame.
  void choose(const std::vector<double>& spans) {
    chosen_ = true;
    const bool supports_explicit_steps =
        std::all_of(systems_.begin(), systems_.end(), [](const auto& s) { return s->supports_explicit_steps(); });
    if (options_.step <= 0.0 && supports_explicit_steps) {
      central_.emplace_back(*systems_.front(), states_.front().time);
      explicit_steps_ = spans.front() < kExplicitSteps * central_.front().largest_step();
    }
    if (!explicit_steps_) return stepper_.initialise(states_);
    for (std::size_t i = 1; i < systems_.size(); ++i) central_.emplace_back(*systems_[i], states_[i].time);
    for (std::size_t i = 0; i < systems_.size(); ++i) central_[i].initialise(states_[i]);
  }

  void leap(const std::vector<double>& spans) {
    for_each_index(states_.size(), [&](std::size_t i) { central_[i].advance(states_[i], spans[i]); });
    if (options_.after_step) options_.after_step(states_);
  }

  void implicit(std::vector<double> spans) {
    const int count = options_.step > 0.0 ? static_cast<int>(std::ceil(spans.front() / options_.step * (1.0 - 1e-9)))
                                          : options_.steps_per_frame;
    for (double& span : spans) span /= count;
    for (int k = 0; k < count; ++k) {
      if (reactions_.front().rows() > 0) before_ = states_;
      stepper_.step(states_, spans);
      note_reactions();
      if (options_.after_step) options_.after_step(states_);
    }
  }

  // Keeps the reactions of the last two steps, the newest first. A step of generalised-alpha balances the forces within it,
  // and stiff springs ring between its ends.
  void note_reactions() {
    if (before_.empty()) return;
    ++noted_;
    const double share = stepper_.force_share();
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const DynamicState &from = before_[i], &to = states_[i];
      reactions_[i].col(1) = reactions_[i].col(0).eval();
      reactions_[i].col(0) = systems_[i]->reactions((1.0 - share) * to.time + share * from.time,
                                                    (1.0 - share) * to.displacement + share * from.displacement,
                                                    (1.0 - share) * to.velocity + share * from.velocity);
    }
  }

  // Extrapolates them to the end of the last step.
  Eigen::VectorXd reactions(std::size_t i) const {
    const Eigen::MatrixXd& kept = reactions_[i];
    if (noted_ < 2) return systems_[i]->reactions(states_[i].time, states_[i].displacement, states_[i].velocity);
    return kept.col(0) + stepper_.force_share() * (kept.col(0) - kept.col(1));
  }

  FullModel::Options options_;
  Systems systems_;
  GeneralizedAlpha stepper_;
  std::vector<CentralDifference> central_;
  std::vector<DynamicState> states_;
  std::vector<DynamicState> before_;        ///< states before the last step; empty where nothing is moved
  std::vector<Eigen::MatrixXd> reactions_;  ///< of each run in its last two steps
  int noted_ = 0;                           ///< steps
  bool chosen_ = false, explicit_steps_ = false;
};

class FullTrajectory : public Trajectory {
 public:
  FullTrajectory(const Model& model, const Eigen::VectorXd& theta, DynamicState state, const FullModel::Options& options)
      : runs_(model, {theta}, {std::move(state)}, options) {}
  const DynamicState& state() const { return runs_.state(0); }
  void advance(double time) override { runs_.advance({time}); }
  double time() const override { return runs_.state(0).time; }
  Eigen::VectorXd displacement() const override { return runs_.state(0).displacement; }
  Eigen::VectorXd output() const override { return runs_.output(0); }
  Eigen::VectorXd velocity() const override { return runs_.state(0).velocity; }

 private:
  FullTrajectories runs_;
};

}  // namespace

// The linear form finds the static equilibrium and the smooth motions of the start.
FullModel::FullModel(const Model& model, const Options& options) : model_(model), options_(options) {
  if (model.starts_in_motion()) linear_form_ = std::make_unique<ReducedModel>(model, BasisOptions().linear_form());
}

FullModel::~FullModel() = default;

std::unique_ptr<Trajectory> FullModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<FullTrajectory>(model_, theta, at_start(model_, theta, start, linear_form_.get()), options_);
}

std::vector<DynamicState> FullModel::states(const Eigen::VectorXd& theta, double start, const std::vector<double>& times,
                                            const std::function<void()>& checkpoint) const {
  std::vector<DynamicState> out{at_start(model_, theta, start, linear_form_.get())};
  GeneralizedAlpha(ModelSystem(model_, theta), options_.spectral_radius, options_.tolerance).initialise(out.front());
  FullTrajectory run(model_, theta, out.front(), options_);
  for (const double time : times) {
    checkpoint();
    run.advance(time);
    if (time > out.back().time) out.push_back(run.state());
  }
  return out;
}

std::unique_ptr<Trajectory> FullModel::resume(const Eigen::VectorXd& theta, const Trajectory& from) const {
  return std::make_unique<FullTrajectory>(model_, theta, dynamic_cast<const FullTrajectory&>(from).state(), options_);
}

bool FullModel::hold_the_same(const std::vector<Eigen::VectorXd>& thetas) const {
  return std::all_of(thetas.begin(), thetas.end(),
                     [&](const Eigen::VectorXd& theta) { return model_.fixed(theta) == model_.fixed(thetas.front()); });
}

std::unique_ptr<Trajectories> FullModel::resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                                    const Trajectory& from) const {
  if (!hold_the_same(thetas)) return ForwardModel::resume_all(thetas, from);
  const DynamicState& state = dynamic_cast<const FullTrajectory&>(from).state();
  return std::make_unique<FullTrajectories>(model_, thetas, std::vector<DynamicState>(thetas.size(), state), options_);
}

std::unique_ptr<Trajectories> FullModel::start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  if (!hold_the_same(thetas)) return ForwardModel::start_all(thetas, start);
  std::vector<DynamicState> states;
  states.reserve(thetas.size());
  for (const Eigen::VectorXd& theta : thetas) states.push_back(at_start(model_, theta, start, linear_form_.get()));
  return std::make_unique<FullTrajectories>(model_, thetas, std::move(states), options_);
}

std::string FullModel::description() const {
  const std::string scheme = options_.spectral_radius < 1.0 ? "generalised-alpha" : "Newmark";
  const std::string step =
      options_.step > 0.0 ? std::to_string(options_.step) + " s a step"
                          : std::to_string(options_.steps_per_frame) + " steps a frame (explicit when fewer than " +
                                std::to_string(static_cast<int>(kExplicitSteps)) + " stable steps span the first frame)";
  return "full: " + std::to_string(model_.fem().dof_count()) + " degrees of freedom, " + scheme + ", " + step;
}

ModelSystem::ModelSystem(const Model& model, const Eigen::VectorXd& theta)
    : model_(model),
      point_(model.point(theta)),
      mass_(model.mass(theta)),
      stiffness_(model.stiffness(theta)),
      fixed_(model.fixed(theta)),
      relaxations_(model.relaxations(theta)) {
  const double alpha = model.mass_damping(theta), beta = model.stiffness_damping(theta),
               inertia = model.stiffness_inertia(theta);
  mass_.prune(0.0);  // of each pair of nodes' 3 x 3 block, a third
  linear_part_ = stiffness_.coeffs().cwiseAbs().maxCoeff() > 0.0;
  damped_ = alpha > 0.0 || beta > 0.0;
  if (inertia > 0.0 || !relaxations_.empty()) reference_ = model.reference_stiffness(theta);
  if (beta > 0.0 || !relaxations_.empty()) linear_reference_ = model.linear_reference_stiffness(theta);
  strains_relax_ = !relaxations_.empty() && model.may_be_finite();
  if (damped_) {
    damping_ = alpha * mass_;
    if (beta > 0.0) damping_ += beta * linear_reference_;
  }
  gravity_ = mass_ * model.body_acceleration(theta).replicate(mass_.rows() / 3, 1);
  if (inertia > 0.0) mass_ += inertia * reference_;
  const bool rubs = model.has_friction(point_);
  velocity_tangent_ = rubs || model.has_finite_damping(point_);
  explicit_steps_ = !(inertia > 0.0) && !rubs;
  if (!linear_part_) deformation_.emplace(model.fem());
}

void ModelSystem::add_force(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v, Eigen::VectorXd& force) const {
  force += gravity_;
  if (linear_part_) subtract_product(stiffness_, u, force);
  model_.add_loads(point_, time, force);
  model_.add_nonlinear_force(point_, {time, u, v}, force);
}

void ModelSystem::find_relaxing_strain(const Eigen::VectorXd& u, Eigen::VectorXd& strain) const {
  if (!strains_relax_) return DynamicSystem::find_relaxing_strain(u, strain);
  strain.resize(u.size() + strain_count(model_.fem()));
  strain.head(u.size()) = u;
  green_strains(model_.fem(), u, strain.tail(strain.size() - u.size()));
}

void ModelSystem::subtract_relaxing_force(const Eigen::VectorXd& u, const Eigen::VectorXd& stretch,
                                          Eigen::VectorXd& force) const {
  if (!strains_relax_) return subtract_product(linear_reference_, stretch, force);
  subtract_product(linear_reference_, stretch.head(u.size()), force);
  model_.add_strain_force(point_, u, stretch.tail(stretch.size() - u.size()), force);
}

SparseMatrix ModelSystem::stiffness(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  SparseMatrix k = stiffness_;
  model_.add_nonlinear_stiffness(point_, {time, u, v}, k);
  return k;
}

SparseMatrix ModelSystem::friction(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  SparseMatrix c = model_.fem().pattern();
  model_.add_velocity_tangent(point_, {time, u, v}, c);
  return c;
}

void ModelSystem::find_deformation(const Eigen::VectorXd& u, Eigen::Matrix3Xd& gradients) const {
  deformation_ ? deformation_->find(u, gradients) : DynamicSystem::find_deformation(u, gradients);
}

double ModelSystem::largest_lame_ratio() const {
  double largest = 0.0;
  for (int e = 0; e < model_.fem().element_count(); ++e) {
    Lame sum{0.0, 0.0};
    for (std::size_t i = 0; i < model_.parts().size(); ++i) {
      const FiniteStrainForm* form = model_.parts()[i].effect->finite_strain();
      if (form == nullptr || form->point_form() == nullptr) continue;
      const Lame own = form->point_form()->rest_moduli(e, 0, point_.parts[i].parameters);
      sum = {sum.lambda + own.lambda, sum.mu + own.mu};
    }
    if (sum.mu > 0.0) largest = std::max(largest, sum.lambda / sum.mu);
  }
  return largest;
}

Eigen::VectorXd ModelSystem::reactions(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  Eigen::VectorXd out(model_.output_size() - u.size());
  model_.find_reactions(point_, {time, u, v}, out);
  return out;
}

double ModelSystem::energy(double time, const Eigen::VectorXd& u, const Eigen::VectorXd& v) const {
  return 0.5 * v.dot(mass_ * v) + model_.stored_energy(point_, {time, u, v}) - gravity_.dot(u);
}

}  // namespace tissue_stiffness
