#include "export/exported_model.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "effects/registry.hpp"
#include "fem/neo_hookean.hpp"
#include "fem/strain.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Effects that the value holds. Every other one is named in its remarks.
const std::set<std::string> kElastic = {"stiff_inclusion", "compressibility"};  // their stiffness is isotropic
const std::set<std::string> kLoads = {"traction", "pressure", "load_offset", "pressure_offset", "load_rotation"};
const std::set<std::string> kOthers = {
    "inertia",      "elasticity",      "fixed",         "moved",       "gravity",
    "mass_damping", "viscous_damping", "density_error", "force_scale", "geometric_nonlinearity"};

bool is_held(const std::string& effect) {
  return kElastic.count(effect) + kLoads.count(effect) + kOthers.count(effect) > 0;
}

std::string name_of(const EffectSettings& effect) {
  return effect.label + (effect.arguments.has("region") ? " on " + effect.arguments.at("region").as_text() : "");
}

// Returns whether the effect's amplitudes are all at their absent value.
bool is_absent(const EffectSettings& effect, const Eigen::VectorXd& parameters) {
  bool amplitude = false;
  Eigen::Index i = 0;
  for (const ParameterSpec& spec : effect_spec(effect).parameters) {
    for (int c = 0; c < spec.components; ++c, ++i) {
      if (std::isnan(spec.absent)) continue;
      amplitude = true;
      if (parameters[i] != spec.absent) return false;
    }
  }
  return amplitude;
}

Eigen::Matrix3Xd by_node(const Eigen::VectorXd& dofs) {
  return Eigen::Map<const Eigen::Matrix3Xd>(dofs.data(), 3, dofs.size() / 3);
}

// Averages a value over an element's quadrature points, exactly where it is constant.
template <typename Value>
auto mean_over(const Discretisation& fem, int e, const Value& value) {
  const auto first = value(0);
  auto sum = first;
  sum.setZero();
  double volume = 0.0;
  for (int q = 0; q < fem.points_per_element(); ++q) {
    sum += fem.weight(e, q) * (value(q) - first);
    volume += fem.weight(e, q);
  }
  return (first + sum / volume).eval();
}

// Reads lambda and mu of an isotropic D = R R^T.
Eigen::Vector2d moduli_of(const StrainFactor& factor) {
  if (factor.cols() == 0) return Eigen::Vector2d::Zero();
  return {factor.row(0).dot(factor.row(1)), 0.5 * factor.row(3).squaredNorm()};
}

// Returns lambda and mu of each tetrahedron, 2 x tetrahedra [Pa].
Eigen::Matrix2Xd moduli(const Model& model, const Eigen::VectorXd& theta) {
  const Discretisation& fem = model.fem();
  Eigen::Matrix2Xd out = Eigen::Matrix2Xd::Zero(2, fem.element_count());
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    const EffectSettings& effect = model.settings().effects[i];
    const Eigen::VectorXd p = model.parts()[i].parameters(theta);
    if (effect.name == "elasticity") {
      const Lame here = lame(p[0], p[1]);
      for (const int e : solid_elements(effect.arguments, fem.element_count(), model.body().regions))
        out.col(e) += Eigen::Vector2d(here.lambda, here.mu);
    }
    if (kElastic.count(effect.name) == 0) continue;
    for (const StrainTerm& term : model.parts()[i].terms.strain_stiffness) {
      const double scale = term.coefficient(p);
      for (int e = 0; scale != 0.0 && e < fem.element_count(); ++e)
        out.col(e) += scale * mean_over(fem, e, [&](int q) { return moduli_of(term.factor(e, q, p)); });
    }
  }
  return out;
}

void set_material(const Model& model, const Eigen::VectorXd& theta, ExportedModel& out) {
  const Eigen::Matrix2Xd all = moduli(model, theta);
  const Eigen::ArrayXd lambda = all.row(0).transpose().array(), mu = all.row(1).transpose().array();
  Eigen::Index empty = 0;
  if (!(mu.minCoeff(&empty) > 0.0)) {
    throw InputError(model.settings().name + ": effects", "no elasticity in tetrahedron " + std::to_string(empty),
                     "regions of elasticity that fill the body");
  }
  out.young_modulus = mu * (3.0 * lambda + 2.0 * mu) / (lambda + mu);
  out.poisson_ratio = 0.5 * lambda / (lambda + mu);
  double density = 0.0;
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    if (model.settings().effects[i].name == "inertia") density += model.parts()[i].parameters(theta)[0];
  }
  out.density.setConstant(model.fem().element_count(), density * model.mass_factor(theta));
}

double value_of(const Model& model, const LoadTerm& term, const Eigen::VectorXd& p, double factor, double time) {
  return term.coefficient(p) * model.loads().value(term, p, factor, time);
}

// Returns the forces of a part's loads at rest [N].
Eigen::VectorXd force_of(const Model& model, const Model::Part& part, const Eigen::VectorXd& theta, double time) {
  Eigen::VectorXd force = Eigen::VectorXd::Zero(model.fem().dof_count());
  const Eigen::VectorXd p = part.parameters(theta);
  const double factor = model.load_factor(theta);
  for (const LoadTerm& term : part.terms.loads) {
    force += value_of(model, term, p, factor, time) * (term.shaped ? term.shaped(p) : term.pattern);
  }
  return force;
}

// Returns d + (R - I) X of the region that the part moves, without nodes that are held at rest.
ExportedMotion motion_of(const Model& model, std::size_t part, double time) {
  const EffectSettings& effect = model.settings().effects[part];
  ExportedMotion out;
  out.name = name_of(effect);
  for (const int node : find_region(effect.arguments.at("region"), model.body().regions).nodes) {
    if (model.fixed()[3 * static_cast<std::size_t>(node)] == 0) out.nodes.push_back(node);
  }
  const Course& course = *model.parts()[part].terms.loads.front().course;
  Eigen::Matrix<double, 3, 4> motion;  // d, and the columns of R - I
  for (int i = 0; i < motion.size(); ++i) motion(i % 3, i / 3) = course.value(time, i);
  out.displacement.resize(3, static_cast<Eigen::Index>(out.nodes.size()));
  for (std::size_t i = 0; i < out.nodes.size(); ++i) {
    out.displacement.col(static_cast<Eigen::Index>(i)) =
        motion.col(0) + motion.rightCols<3>() * model.mesh().nodes.col(out.nodes[i]);
  }
  return out;
}

void add_remarks(const Model& model, const Eigen::VectorXd& theta, ExportedModel& out) {
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    const EffectSettings& effect = model.settings().effects[i];
    const Eigen::VectorXd p = model.parts()[i].parameters(theta);
    const EffectSpec& spec = effect_spec(effect);
    const std::string name = name_of(effect);
    if (!is_held(effect.name) && !is_absent(effect, p)) {
      const bool sensor = model.parts()[i].effect->sensor_model() != nullptr;
      out.remarks.push_back(name + " is left out: " + (sensor ? "it belongs to a sensor (" : "") + spec.summary +
                            (sensor ? ")" : ""));
    }
    if (out.finite_strain && kLoads.count(effect.name) == 1 && model.parts()[i].effect->finite_strain() != nullptr)
      out.remarks.push_back(name + " keeps its direction at rest here; in the model it follows the surface");
    if (effect.name == "stiff_inclusion" && !is_absent(effect, p))
      out.remarks.push_back(name + " has one modulus in each tetrahedron here; in the model its edge cuts through them");
    if (effect.name == "moved" && p[0] > 0.0)
      out.remarks.push_back(name + " is firm here; in the model an elastic layer is between");
  }
  if (!model.initial_velocity(theta).isZero(0.0)) out.remarks.emplace_back("the initial velocity is left out");
}

void set_strain(const Model& model, const Eigen::VectorXd& theta, ExportedModel& out) {
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    if (model.settings().effects[i].name != "elasticity") continue;
    const double share = model.finite_share(model.parts()[i], theta);
    out.finite_strain = share == 1.0;
    if (share == 0.0 || share == 1.0) continue;
    std::ostringstream text;
    text << "geometric_nonlinearity is left out: its share of finite strain is " << share << ", neither 0 nor 1";
    out.remarks.push_back(text.str());
    return;
  }
}

}  // namespace

Eigen::Matrix3Xd ExportedModel::force() const {
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, mesh.node_count());
  for (const ExportedLoad& load : loads) sum += load.force;
  return sum;
}

// What is left out is as the model without the effect. A compliant support is then rigid, so `fixed` is not theta's.
ExportedModel export_model(const Model& model, const Eigen::VectorXd& theta, double time,
                           const Eigen::VectorXd& mapped_modulus, double common_modulus) {
  ExportedModel out;
  out.time = time - model.loads().first_stamp();
  out.mesh = model.mesh();
  set_material(model, theta, out);
  for (Eigen::Index e = 0; e < mapped_modulus.size(); ++e) {
    if (!std::isnan(mapped_modulus[e])) out.young_modulus[e] *= mapped_modulus[e] / common_modulus;
  }
  set_strain(model, theta, out);
  for (int node = 0; node < model.mesh().node_count(); ++node)
    out.fixed.push_back(model.fixed()[3 * static_cast<std::size_t>(node)]);
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    const EffectSettings& effect = model.settings().effects[i];
    if (kLoads.count(effect.name) == 1)
      out.loads.push_back({name_of(effect), by_node(force_of(model, model.parts()[i], theta, time))});
    if (effect.name == "moved") out.motions.push_back(motion_of(model, i, time));
  }
  out.gravity = model.body_acceleration(theta);
  Eigen::VectorXd acceleration(model.fem().dof_count());
  acceleration = out.gravity.replicate(model.fem().node_count(), 1);
  out.weight = by_node(model.fem().mass(out.density) * acceleration);
  out.mass_damping = model.mass_damping(theta);
  out.stiffness_damping = model.stiffness_damping(theta);
  add_remarks(model, theta, out);
  return out;
}

double time_of_largest_load(const Model& model, const Eigen::VectorXd& theta, const std::vector<double>& times) {
  const double first = model.loads().first_stamp();
  double best = first, largest_force = 0.0, largest_motion = 0.0;
  for (const double time : times) {
    if (time < first) continue;
    Eigen::VectorXd force = Eigen::VectorXd::Zero(model.fem().dof_count());
    double motion = 0.0;
    for (std::size_t i = 0; i < model.parts().size(); ++i) {
      const std::string& effect = model.settings().effects[i].name;
      if (kLoads.count(effect) == 1) force += force_of(model, model.parts()[i], theta, time);
      if (effect == "moved") motion += motion_of(model, i, time).displacement.squaredNorm();
    }
    const double size = force.norm();
    if (size > largest_force || (largest_force == 0.0 && motion > largest_motion)) best = time;
    largest_force = std::max(largest_force, size);
    largest_motion = std::max(largest_motion, motion);
  }
  return best;
}

}  // namespace tissue_stiffness
