#include "forward/contact_model.hpp"

#include <algorithm>
#include <set>

#include "forward/contact_trajectory.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kKept = 8;  // static responses of the last theta

std::vector<int> touching_nodes(const Model& model) {
  std::set<int> nodes;
  for (const Model::Part& part : model.parts()) {
    if (const Contact* contact = part.effect->contact()) nodes.insert(contact->nodes().begin(), contact->nodes().end());
  }
  return {nodes.begin(), nodes.end()};
}

}  // namespace

bool ContactModel::suits(const Model& model) {
  const auto is_contact = [](const Model::Part& part) { return part.effect->contact() != nullptr; };
  const auto linear = [&](const Model::Part& part) {
    return part.effect->nonlinear_force() == nullptr || is_contact(part);
  };
  const std::vector<char> fixed = model.fixed(model.prior_theta());
  return !model.may_be_finite() && std::any_of(model.parts().begin(), model.parts().end(), is_contact) &&
         std::all_of(model.parts().begin(), model.parts().end(), linear) &&
         std::find(fixed.begin(), fixed.end(), char{1}) != fixed.end();
}

ContactModel::ContactModel(const Model& model, const BasisOptions& options, const ReducedModel* relative)
    : reduced_(model, options.linear_form(), relative),
      nodes_(touching_nodes(model)),
      places_(static_cast<std::size_t>(model.fem().node_count()), -1),
      basis_(reduced_.basis_at(nodes_)) {
  for (const int node : nodes_) {
    places_[static_cast<std::size_t>(node)] = static_cast<int>(dofs_.size());
    for (int axis = 0; axis < 3; ++axis) dofs_.push_back(3 * node + axis);
  }
}

ContactModel::Flexibility ContactModel::flexibility(const Eigen::VectorXd& theta) const {
  const SparseMatrix stiffness = model().rest_stiffness(theta);
  const std::vector<char> fixed = model().fixed(theta);
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const auto& known : known_) {
      if (const double ratio = known->ratio(stiffness, fixed); ratio > 0.0) return {known, ratio};
    }
  }
  auto made = std::make_shared<const NodalFlexibility>(stiffness, fixed, dofs_);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (known_.size() == kKept) known_.erase(known_.begin());
  known_.push_back(made);
  return {made, 1.0};
}

std::unique_ptr<Trajectory> ContactModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<ContactTrajectory>(*this, theta, start);
}

std::unique_ptr<Trajectory> ContactModel::resume(const Eigen::VectorXd& theta, const Trajectory& from) const {
  return std::make_unique<ContactTrajectory>(*this, theta, dynamic_cast<const ContactTrajectory&>(from));
}

void ContactModel::restrict_output_to(const OutputNodes& nodes) {
  reduced_.restrict_output_to(nodes);
}

std::string ContactModel::description() const {
  return reduced_.description() + ", with the static response of " + std::to_string(nodes_.size()) +
         " nodes that a contact may touch";
}

}  // namespace tissue_stiffness
