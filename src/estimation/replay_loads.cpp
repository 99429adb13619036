#include "estimation/replay_loads.hpp"

#include <vector>

#include "effects/registry.hpp"
#include "meshing/surface.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kMostHeld = 400;

std::string name_of(const EffectSettings& effect) {
  return effect.label + (effect.arguments.has("region") ? " on " + effect.arguments.at("region").as_text() : "");
}

/// Returns about kMostHeld of the surface's nodes that are held at rest.
Eigen::Matrix3Xd held_places(const Model& model) {
  std::vector<int> held;
  for (const int node : surface_nodes(model.mesh())) {
    if (model.fixed()[3 * static_cast<std::size_t>(node)] != 0) held.push_back(node);
  }
  const std::size_t step = 1 + held.size() / kMostHeld;
  Eigen::Matrix3Xd out(3, static_cast<Eigen::Index>((held.size() + step - 1) / step));
  for (Eigen::Index i = 0; i < out.cols(); ++i)
    out.col(i) = model.mesh().nodes.col(held[static_cast<std::size_t>(i) * step]);
  return out;
}

/// One load term at theta: the sum of its pattern, and what of it acts where.
struct ActingTerm {
  const LoadTerm* term;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();  ///< of the forces' sizes
  double size = 0.0;
};

ActingTerm acting(const LoadTerm& term, const Eigen::VectorXd& p, const Eigen::Matrix3Xd& nodes) {
  ActingTerm out{&term};
  const Eigen::VectorXd pattern = term.shaped ? term.shaped(p) : term.pattern;
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    const Eigen::Vector3d force = pattern.segment<3>(3 * i);
    out.sum += force;
    out.moment += force.norm() * nodes.col(i);
    out.size += force.norm();
  }
  return out;
}

ReplayLoad force_of(const Model& model, const Model::Part& part, const Eigen::VectorXd& theta,
                    const std::vector<double>& times) {
  const Eigen::VectorXd p = part.parameters(theta);
  std::vector<ActingTerm> terms;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double size = 0.0;
  for (const LoadTerm& term : part.terms.loads) {
    terms.push_back(acting(term, p, model.mesh().nodes));
    moment += terms.back().moment;
    size += terms.back().size;
  }
  ReplayLoad out{{}, "N", size > 0.0 ? Eigen::Vector3d(moment / size) : Eigen::Vector3d::Zero(), {}};
  out.value.setZero(3, static_cast<Eigen::Index>(times.size()));
  const double factor = model.load_factor(theta);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double time = model.loads().first_stamp() + times[k];
    for (const ActingTerm& acts : terms) {
      out.value.col(static_cast<Eigen::Index>(k)) +=
          acts.term->coefficient(p) * model.loads().value(*acts.term, p, factor, time) * acts.sum;
    }
  }
  return out;
}

ReplayLoad motion_of(const Model& model, const Model::Part& part, const Region& region, const std::vector<double>& times) {
  ReplayLoad out{{}, "m", Eigen::Vector3d::Zero(), {}};
  for (const int node : region.nodes) out.place += model.mesh().nodes.col(node) / static_cast<double>(region.nodes.size());
  out.value.resize(3, static_cast<Eigen::Index>(times.size()));
  const Course& course = *part.terms.loads.front().course;
  for (std::size_t k = 0; k < times.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      out.value(axis, static_cast<Eigen::Index>(k)) = course.value(model.loads().first_stamp() + times[k], axis);
  }
  return out;
}

}  // namespace

void add_loads(const Model& model, const Eigen::VectorXd& theta, Replay& replay) {
  replay.held = held_places(model);
  for (std::size_t i = 0; i < model.parts().size(); ++i) {
    const EffectSettings& effect = model.settings().effects[i];
    const Model::Part& part = model.parts()[i];
    const bool moved = effect.name == "moved";
    if (!moved && effect.name != "traction" && effect.name != "pressure") continue;
    replay.loads.push_back(
        moved ? motion_of(model, part, find_region(effect.arguments.at("region"), model.body().regions), replay.time)
              : force_of(model, part, theta, replay.time));
    replay.loads.back().name = name_of(effect);
  }
}

}  // namespace tissue_stiffness
