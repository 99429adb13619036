// Fibres pull actively, in a rhythm of their own.
#include <algorithm>
#include <cmath>
#include <functional>

#include "effects/fibre_field.hpp"
#include "effects/registry.hpp"
#include "fem/point_assembly.hpp"

namespace tissue_stiffness::effects {
namespace {

enum Index { kAmplitude, kPeriod, kOnset, kDuration, kSharpness, kPeak, kAngle, kTilt };

// Returns the pulse of the active part of each period, and zero before the onset.
double twitch(double time, const Parameters& p) {
  const double since = time - p[kOnset];
  if (since <= 0.0) return 0.0;
  const double within = since - p[kPeriod] * std::floor(since / p[kPeriod]);
  const double part = within / std::min(p[kDuration], p[kPeriod]);
  const double height = std::min(part / p[kPeak], (1.0 - part) / (1.0 - p[kPeak]));
  return height > 0.0 ? std::pow(std::sin(0.5 * M_PI * height), p[kSharpness]) : 0.0;
}

class ActiveContraction : public Effect, public FiniteStrainForm {
 public:
  ActiveContraction(const Value& arguments, const EffectContext& context)
      : fem_(context.fem), points_(context.fem), fibres_(arguments, context) {
    if (arguments.has("course")) course_ = load_csv(arguments.at("course"), LoadInput::Kind::pressure, context);
  }

  void linear_terms(LinearTerms& out) const override {
    LoadTerm load;
    load.coefficient = [](const Parameters& p) { return p[kAmplitude]; };
    load.activation = [this](double time, const Parameters& p) { return activation(time, p); };
    load.shaped = [this](const Parameters& p) {
      const auto pull = [&](int e, int q) { return strain_of(direction(e, q, p)); };
      Eigen::VectorXd force = Eigen::VectorXd::Zero(fem_.dof_count());
      add_stress_force(fem_, pull, force);
      return force;
    };
    load.shape = {kAngle, kTilt};
    out.loads.push_back(std::move(load));
  }
  const FiniteStrainForm* finite_strain() const override { return this; }
  void add_finite_force(const Motion& motion, const Parameters& p, Eigen::VectorXd& force) const override {
    const double now = p[kAmplitude] * activation(motion.since, p);
    const auto stress = [&](int e, int q, const Eigen::Matrix3d& f, Eigen::Matrix3d& out) {
      add_fibre_stress({now, 0.0}, direction(e, q, p), f, out);
    };
    if (now != 0.0) points_.add_force(std::cref(stress), motion.displacement, force);
  }
  void add_finite_stiffness(const Motion& motion, const Parameters& p, SparseMatrix& stiffness) const override {
    const double now = p[kAmplitude] * activation(motion.since, p);
    const auto tangent = [&](int e, int q, const Eigen::Matrix3d& f, StressTangent& out) {
      add_fibre_tangent({now, 0.0}, direction(e, q, p), f, out);
    };
    if (now != 0.0) points_.add_stiffness(std::cref(tangent), motion.displacement, stiffness);
  }

 private:
  double activation(double time, const Parameters& p) const { return course_ ? course_->value(time, 0) : twitch(time, p); }
  Eigen::Vector3d direction(int e, int q, const Parameters& p) const {
    return fibres_.direction(e, q, p[kAngle], p[kTilt]);
  }

  const Discretisation& fem_;
  PointAssembly points_;
  FibreField fibres_;
  std::shared_ptr<const Course> course_;
};

constexpr double kCycles[] = {1.0, 2.0, 3.0, 4.0, 6.0};    // in the recording, where no rhythm is known
constexpr double kPhases[] = {0.0, 1.0 / 3.0, 2.0 / 3.0};  // of the period

std::vector<double> periods(const ProposalContext& context) {
  if (!context.periods.empty()) return context.periods;
  std::vector<double> list;
  for (const double cycles : kCycles) list.push_back(context.duration / cycles);
  return list;
}

// Muscle tightens and relaxes at rates of its own, and another shape of the pulse rings the body otherwise.
EffectEntry with_any_shape(EffectEntry pulse) {
  pulse.arguments.emplace_back("peak", log_normal_prior(0.5, 1.3));
  pulse.arguments.emplace_back("sharpness", log_normal_prior(2.0, 1.5));
  return pulse;
}

// Proposes pulses half a period long, at a few periods and phases. The fit of the best ones finds their shape, too.
// It keeps the sign, because muscle pulls.
std::vector<Proposal> propose(const ProposalContext& context) {
  if (context.holds("active_contraction")) return {};
  const double scale = 0.03 * context.young_modulus;
  std::vector<Proposal> list;
  for (const FibreField::Trial& trial : FibreField::trials(context.mesh)) {
    if (trial.angle != 0.0 || trial.direction.is("radial")) continue;
    const auto with = [&trial](const Argument& period, const Argument& onset, const Argument& duration,
                               const Quantity& amplitude) {
      return EffectEntry{"active_contraction",
                         {{"direction", trial.direction},
                          {"period", period},
                          {"onset", onset},
                          {"duration", duration},
                          {"amplitude", amplitude}}};
    };
    for (const double period : periods(context)) {
      for (const double phase : kPhases) {
        const double onset = phase * period, arch = 0.5 * period;
        list.push_back({with(period, onset, arch, normal_prior(0.0, scale)),
                        "amplitude",
                        with_any_shape(with(log_normal_prior(period, 1.15), normal_prior(onset, 0.2 * period),
                                            log_normal_prior(arch, 1.5), log_normal_prior(scale, 4.0))),
                        {"direction"}});
      }
    }
  }
  return list;
}

}  // namespace

EffectSpec active_contraction_spec() {
  EffectSpec spec;
  spec.name = "active_contraction";
  spec.summary = "fibres that pull in a rhythm of their own, an arch in each period; below zero they push";
  spec.formula =
      "stress T f(t) a a^T, f = sin^n(pi/2 min(x / (c d), (d - x) / (d - c d))) for x = (t - t0) mod P < d, else 0; "
      "nothing before t0";
  spec.source =
      "active stress, Smith et al. 2004; ramps of unequal length, Korakianitis & Shi 2006, J. Biomech. 39, p. 1964; t "
      "counts from the recording's first stamp";
  spec.parameters = {{"amplitude", "T", "Pa", -1e9, 1e9, ParameterSpec::Default::required, 0.0, 0.0, 1},
                     {"period", "P", "s", 1e-3, 1e6, ParameterSpec::Default::optional, 1.0, NAN, 1},
                     {"onset", "t0", "s", -1e6, 1e6, ParameterSpec::Default::optional, 0.0, NAN, 1},
                     {"duration", "d", "s", 1e-3, 1e6, ParameterSpec::Default::optional, 1e6, NAN, 1},
                     {"sharpness", "n", "-", 1.0, 20.0, ParameterSpec::Default::optional, 2.0, NAN, 1},
                     {"peak", "c", "-", 0.02, 0.98, ParameterSpec::Default::optional, 0.5, NAN, 1}};
  for (const ParameterSpec& angle : FibreField::angles()) spec.parameters.push_back(angle);
  spec.keys = FibreField::keys();
  spec.keys.push_back({"course", "{file: a.csv} with rows of time [s], f [-]; instead of the rhythm"});
  spec.proposals = propose;
  return spec;
}

std::unique_ptr<Effect> make_active_contraction(const Value& arguments, const EffectContext& context) {
  return std::make_unique<ActiveContraction>(arguments, context);
}

}  // namespace tissue_stiffness::effects
