#include "forward/contact_trajectory.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "forward/force_steps.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSettled = 1e-6;  // body sizes; a step of Newton's method leaves far less than what it changes
constexpr int kMostIterations = 60;
constexpr double kFlat = 0.1;  // of the slope along a step of Newton's method, where the search along it ends
constexpr int kMostSearches = 20;
constexpr double kSolved = 1e-5;     // of the residual that the forces start from
constexpr double kTravel = 0.01;     // of a tool's size, in a step
constexpr double kMostGrowth = 2.4;  // of a step over the last, for BDF2 to be stable: 1 + sqrt(2) (Grigorieff 1983)

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& m, const std::vector<int>& rows) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), m.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = m.row(rows[i]);
  return out;
}

std::vector<int> nonzero(const Eigen::VectorXd& v) {
  std::vector<int> out;
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    if (v[i] != 0.0) out.push_back(static_cast<int>(i));
  }
  return out;
}

Eigen::Matrix3d convex_part(const Eigen::Matrix3d& m) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(m);
  return solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() * solver.eigenvectors().transpose();
}

/// -d force / d displacement between touched degrees of freedom [N/m], a block for each facet.
class ContactStiffness {
 public:
  /// `index`: the row of each of the model's dofs(). `convex`: take the convex part of each point's stiffness.
  ContactStiffness(const ContactModel& owner, const std::vector<Contact::Touch>& touches, const std::vector<int>& index,
                   double span, bool convex) {
    for (std::size_t first = 0, end = 0; first < touches.size(); first = end) {  // a facet's points follow each other
      const auto& nodes = touches[first].nodes;
      Facet facet{{}, Eigen::MatrixXd::Zero(3 * nodes.size(), 3 * nodes.size())};
      for (Eigen::Index a = 0; a < nodes.size(); ++a)
        facet.rows.push_back(index[static_cast<std::size_t>(owner.place(nodes[a]))]);
      for (; end < touches.size() && touches[end].nodes == nodes; ++end) {
        const Contact::Touch& touch = touches[end];
        const Eigen::Matrix3d all = touch.stiffness + touch.damping / span;
        const Eigen::Matrix3d point = convex ? convex_part(all) : all;
        for (Eigen::Index b = 0; b < nodes.size(); ++b) {
          for (Eigen::Index a = 0; a < nodes.size(); ++a)
            facet.block.block<3, 3>(3 * a, 3 * b) += touch.shape[a] * touch.shape[b] * point;
        }
      }
      facets_.push_back(std::move(facet));
    }
  }

  Eigen::VectorXd operator*(const Eigen::VectorXd& u) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(u.size());
    for (const Facet& facet : facets_) {
      Eigen::VectorXd own(facet.block.rows());
      for (std::size_t a = 0; a < facet.rows.size(); ++a)
        own.segment<3>(3 * static_cast<Eigen::Index>(a)) = u.segment<3>(facet.rows[a]);
      const Eigen::VectorXd force = facet.block * own;
      for (std::size_t a = 0; a < facet.rows.size(); ++a)
        out.segment<3>(facet.rows[a]) += force.segment<3>(3 * static_cast<Eigen::Index>(a));
    }
    return out;
  }

 private:
  struct Facet {
    std::vector<int> rows;  ///< first one of each node
    Eigen::MatrixXd block;
  };
  std::vector<Facet> facets_;
};

/// H between touched degrees of freedom [m/N], in the parts that it is the sum of.
struct ContactResponse {
  const Eigen::MatrixXd& unit;    ///< static response
  double share;                   ///< of it
  const Eigen::MatrixXd& shapes;  ///< of the modes
  Eigen::VectorXd modal;          ///< displacement of each mode by a unit force

  Eigen::VectorXd operator*(const Eigen::VectorXd& f) const {
    return share * (unit * f) + shapes * modal.cwiseProduct(shapes.transpose() * f);
  }
};

/// Solves (1 + K H) f = b by conjugate gradients in the inner product f^T H g, in which that matrix is symmetric. Returns
/// false where it is not positive definite.
bool solve_contacts(const ContactStiffness& k, const ContactResponse& h, const Eigen::VectorXd& b, Eigen::VectorXd& f) {
  Eigen::VectorXd residual = b - f - k * (h * f), h_residual = h * residual;
  double size = residual.dot(h_residual);
  const double small = kSolved * kSolved * size;
  Eigen::VectorXd direction = residual, h_direction = h_residual;
  for (Eigen::Index i = 0; i < 2 * b.size() && size > small; ++i) {
    const Eigen::VectorXd image = direction + k * h_direction, h_image = h * image;
    const double curvature = direction.dot(h_image);
    if (!(curvature > 0.0)) return false;
    const double share = size / curvature;
    f += share * direction;
    residual -= share * image;
    h_residual -= share * h_image;
    const double left = residual.dot(h_residual), kept = left / size;
    direction = residual + kept * direction;
    h_direction = h_residual + kept * h_direction;
    size = left;
  }
  return f.allFinite();
}

}  // namespace

ContactTrajectory::ContactTrajectory(const ContactModel& owner, const Eigen::VectorXd& theta, double start)
    : ContactTrajectory(owner, theta, ReducedTrajectory(owner.reduced(), theta, start)) {
  at_ = owner.basis() * linear_.coordinates();
}

ContactTrajectory::ContactTrajectory(const ContactModel& owner, const Eigen::VectorXd& theta, const ContactTrajectory& from)
    : ContactTrajectory(owner, theta, ReducedTrajectory(owner.reduced(), theta, from.linear_)) {
  const Eigen::Index shared = std::min(state_.cols(), from.state_.cols());
  state_.leftCols(shared) = linear_.modes()->to_modal * (from.linear_.modes()->shapes * from.state_.leftCols(shared));
  force_ = from.force_;
  force_rate_ = from.force_rate_;
  modal_force_ = shapes_.transpose() * force_;
  stretch_ = from.stretch_;
  stretch_before_ = from.stretch_before_;
  span_before_ = from.span_before_;
  if (relaxed_.cols() == from.relaxed_.cols()) relaxed_ = from.relaxed_;
  at_ = from.at_;
  reactions_ = from.reactions_;
}

ContactTrajectory::ContactTrajectory(const ContactModel& owner, const Eigen::VectorXd& theta, ReducedTrajectory linear)
    : owner_(owner),
      linear_(std::move(linear)),
      flexibility_(owner.flexibility(theta)),
      stiffness_damping_(owner.model().stiffness_damping(theta)),
      branches_(owner.model().relaxations(theta)),
      shapes_(owner.basis() * linear_.modes()->shapes),
      softness_(linear_.modes()->flexibility()),
      modal_step_(linear_.step()),
      state_(Eigen::MatrixXd::Zero(softness_.size(), modal_step_.states())),
      force_(Eigen::VectorXd::Zero(shapes_.rows())),
      force_rate_(force_),
      modal_force_(Eigen::VectorXd::Zero(softness_.size())),
      stretch_(Eigen::VectorXd::Zero(shapes_.rows())),
      stretch_before_(stretch_),
      relaxed_(Eigen::MatrixXd::Zero(shapes_.rows(), static_cast<Eigen::Index>(branches_.size()))),
      at_(Eigen::VectorXd::Zero(shapes_.rows())),
      reactions_(Eigen::VectorXd::Zero(owner.model().output_size() - owner.model().fem().dof_count())),
      displacement_(Eigen::VectorXd::Zero(owner.model().fem().dof_count())),
      velocity_(displacement_) {
  const Model& model = owner.model();
  for (std::size_t p = 0; p < model.parts().size(); ++p) {
    const Contact* contact = model.parts()[p].effect->contact();
    if (contact == nullptr) continue;
    Eigen::Index reaction = -1;
    for (std::size_t r = 0; r < model.reactions().size(); ++r) {
      if (model.reactions()[r].part == p) reaction = 3 * static_cast<Eigen::Index>(r);
    }
    parts_.push_back({contact, model.parts()[p].parameters(theta), reaction});
  }
}

// Where nothing but tools moves the body, its motion is as slow as theirs: how far they go says how many steps there are.
// The parameters do not, so that runs with other ones differ by these alone.
int ContactTrajectory::steps_to(double time) const {
  const int most = force_steps(time - linear_.time());
  if (!linear_.idle()) return most;
  double travel = 0.0;
  for (const Part& part : parts_) travel = std::max(travel, part.contact->travel(linear_.time(), time, part.parameters));
  return static_cast<int>(std::clamp(std::ceil(travel / kTravel), 1.0, static_cast<double>(most)));
}

void ContactTrajectory::advance(double time) {
  const double start = linear_.time(), span = time - start;
  if (!(span > 0.0)) return;
  const int steps = steps_to(time);
  for (int k = 1; k <= steps; ++k) step(k == steps ? time : start + span * k / steps);
}

ContactTrajectory::Step ContactTrajectory::begin_step(double time) {
  Step out;
  out.time = time;
  out.span = time - linear_.time();
  linear_.advance(time);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(softness_.size()), unit = Eigen::VectorXd::Ones(softness_.size());
  out.modes = state_;
  modal_step_.advance(out.span, modal_force_, none, out.modes);
  Eigen::MatrixXd by_force = Eigen::MatrixXd::Zero(state_.rows(), state_.cols());
  modal_step_.advance(out.span, none, unit, by_force);
  out.modal = by_force.col(0);
  out.free = owner_.basis() * linear_.coordinates() + shapes_ * out.modes.col(0);
  // s' by the differences of three times (BDF2). Where the last step was too short for that to be stable, or there was
  // none, by those of two.
  const double growth = out.span < kMostGrowth * span_before_ ? out.span / span_before_ : 0.0;
  const double damping = stiffness_damping_ / out.span;
  out.memory = damping * ((1.0 + growth) * stretch_ - growth * growth / (1.0 + growth) * stretch_before_);
  out.resistance = 1.0 + damping * (1.0 + 2.0 * growth) / (1.0 + growth);
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const RelaxationStep relaxing(branches_[b], out.span);
    const double gamma = branches_[b].modulus;
    out.resistance += gamma * (1.0 - relaxing.to);
    out.memory += gamma * (relaxing.decay * relaxed_.col(static_cast<Eigen::Index>(b)) + relaxing.from * stretch_);
  }
  const std::vector<int> remembered = nonzero(out.memory);
  if (remembered.empty()) return out;
  const Eigen::VectorXd memory = rows_of(out.memory, remembered);
  const Eigen::MatrixXd shapes = rows_of(shapes_, remembered);
  const Eigen::VectorXd residual = flexibility_.unit->under(remembered, memory) / flexibility_.ratio -
                                   shapes_ * softness_.cwiseProduct(shapes.transpose() * memory);
  out.free += residual / out.resistance;
  return out;
}

const ContactTrajectory::Touched& ContactTrajectory::touched(const std::vector<int>& dofs) {
  if (touched_.dofs != dofs) touched_ = {dofs, flexibility_.unit->between(dofs), rows_of(shapes_, dofs)};
  return touched_;
}

Eigen::VectorXd ContactTrajectory::response(const Step& step, const std::vector<int>& forced,
                                            const Eigen::VectorXd& forces) const {
  const Eigen::VectorXd modal =
      (step.modal - softness_ / step.resistance).cwiseProduct(rows_of(shapes_, forced).transpose() * forces);
  return flexibility_.unit->under(forced, forces) / (flexibility_.ratio * step.resistance) + shapes_ * modal;
}

ContactTrajectory::Contacts ContactTrajectory::contacts_at(const Step& step, Eigen::VectorXd u) {
  const std::vector<int>& dofs = owner_.dofs();
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    displacement_[dofs[i]] = u[k];
    velocity_[dofs[i]] = (u[k] - at_[k]) / step.span;
  }
  Contacts out;
  out.u = std::move(u);
  out.nodal = Eigen::VectorXd::Zero(out.u.size());
  out.reactions = Eigen::VectorXd::Zero(reactions_.size());
  for (const Part& part : parts_) {
    const std::size_t first = out.touches.size();
    part.contact->find({step.time, displacement_, velocity_}, part.parameters, out.touches);
    for (std::size_t t = first; t < out.touches.size() && part.reaction >= 0; ++t) {
      out.reactions.segment<3>(part.reaction) += out.touches[t].force;
    }
  }
  std::vector<char> touched(dofs.size(), 0);
  for (const Contact::Touch& touch : out.touches) {
    for (Eigen::Index a = 0; a < touch.nodes.size(); ++a) {
      const int place = owner_.place(touch.nodes[a]);
      out.nodal.segment<3>(place) += touch.shape[a] * touch.force;
      std::fill_n(touched.begin() + place, 3, char{1});
    }
  }
  for (std::size_t i = 0; i < touched.size(); ++i) {
    if (touched[i] != 0) out.touched.push_back(static_cast<int>(i));
  }
  return out;
}

// Solves u = free + H f(u) with f linearised at the last u: (1 + K H) f = f(u) - K (free - u).
std::optional<ContactTrajectory::NewtonStep> ContactTrajectory::newton_step(const Step& step, const Contacts& contacts,
                                                                            const Eigen::VectorXd& forces,
                                                                            Tangent tangent) {
  NewtonStep out{Eigen::VectorXd::Zero(contacts.u.size()), step.free - contacts.u};
  if (contacts.touched.empty()) return out;
  std::vector<int> index(owner_.dofs().size(), -1);
  for (std::size_t i = 0; i < contacts.touched.size(); ++i)
    index[static_cast<std::size_t>(contacts.touched[i])] = static_cast<int>(i);
  const ContactStiffness k(owner_, contacts.touches, index, step.span, tangent == Tangent::convex);
  const Touched& there = touched(contacts.touched);
  const double share = 1.0 / (flexibility_.ratio * step.resistance);
  const ContactResponse h{there.unit, share, there.shapes, step.modal - softness_ / step.resistance};
  const Eigen::VectorXd right = rows_of(contacts.nodal, contacts.touched) - k * rows_of(out.change, contacts.touched);
  Eigen::VectorXd balanced = rows_of(forces, contacts.touched);
  if (!solve_contacts(k, h, right, balanced)) return std::nullopt;
  for (std::size_t i = 0; i < contacts.touched.size(); ++i)
    out.forces[contacts.touched[i]] = balanced[static_cast<Eigen::Index>(i)];
  out.change += response(step, contacts.touched, balanced);
  return out;
}

// Goes along a step of Newton's method to where the energy 1/2 f^T H f - W(free + H f) is least, W being the contacts'
// work. Its slope along the change of u is change . (f - f(u)).
ContactTrajectory::Contacts ContactTrajectory::search(const Step& step, const Contacts& from, Eigen::VectorXd& forces,
                                                      const NewtonStep& newton) {
  const Eigen::VectorXd more = newton.forces - forces;
  Contacts best = contacts_at(step, from.u + newton.change);
  double low = 0.0, slope_low = newton.change.dot(forces - from.nodal);
  double share = 1.0, slope = newton.change.dot(newton.forces - best.nodal);
  const double flat = kFlat * std::abs(slope_low);
  double high = share, slope_high = slope;
  for (int k = 0; slope_high > flat && std::abs(slope) > flat && k < kMostSearches; ++k) {
    share = low + (high - low) * slope_low / (slope_low - slope_high);
    best = contacts_at(step, from.u + share * newton.change);
    slope = newton.change.dot(forces + share * more - best.nodal);
    // The end that stays loses half of its slope, so that both come closer (the Illinois method).
    if (slope > 0.0) {
      high = share;
      slope_high = slope;
      slope_low *= 0.5;
    } else {
      low = share;
      slope_low = slope;
      slope_high *= 0.5;
    }
  }
  forces += share * more;
  return best;
}

// The exact tangent may not be definite where a curved tool is deep inside the tissue. The energy need not fall along a
// step then, so the convex part of the tangent takes its place (projected Newton, Teran et al. 2005).
void ContactTrajectory::step(double time) {
  const Step step = begin_step(time);
  const double tolerance = kSettled * body_size(owner_.model().mesh().nodes);
  // The forces go on as over the last step.
  Eigen::VectorXd forces = force_ + step.span * force_rate_;
  const std::vector<int> forced = nonzero(forces);
  Contacts now = contacts_at(step, step.free + response(step, forced, rows_of(forces, forced)));
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    std::optional<NewtonStep> newton = newton_step(step, now, forces, Tangent::exact);
    if (!newton || !(newton->change.dot(forces - now.nodal) < 0.0))
      newton = newton_step(step, now, forces, Tangent::convex);
    if (!newton || !newton->change.allFinite()) break;
    const bool settled = newton->change.cwiseAbs().maxCoeff() < tolerance;
    now = search(step, now, forces, *newton);
    if (settled) return end_step(step, now);
  }
  throw NumericalError("the contact does not settle within a step of " + std::to_string(step.span) + " s");
}

void ContactTrajectory::end_step(const Step& step, const Contacts& contacts) {
  const Eigen::VectorXd modal = shapes_.transpose() * contacts.nodal;
  modal_step_.advance(step.span, modal_force_, modal, state_);
  force_rate_ = (contacts.nodal - force_) / step.span;
  force_ = contacts.nodal;
  modal_force_ = modal;
  const Eigen::VectorXd stretch = (contacts.nodal + step.memory) / step.resistance;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const RelaxationStep relaxing(branches_[b], step.span);
    auto z = relaxed_.col(static_cast<Eigen::Index>(b));
    z = (relaxing.decay * z + relaxing.from * stretch_ + relaxing.to * stretch).eval();
  }
  stretch_before_ = std::exchange(stretch_, stretch);
  span_before_ = step.span;
  for (std::size_t i = 0; i < owner_.dofs().size(); ++i)
    at_[static_cast<Eigen::Index>(i)] = displacement_[owner_.dofs()[i]];
  reactions_ = contacts.reactions;
}

Eigen::VectorXd ContactTrajectory::coordinates() const {
  const Eigen::VectorXd own = state_.col(0) - softness_.cwiseProduct(shapes_.transpose() * stretch_);
  return linear_.coordinates() + linear_.modes()->shapes * own;
}

Eigen::VectorXd ContactTrajectory::displacement() const {
  Eigen::VectorXd u(owner_.model().fem().dof_count());
  owner_.reduced().recover(coordinates(), u);
  if (!stretch_.isZero(0.0)) u += flexibility_.unit->response(stretch_) / flexibility_.ratio;
  return u;
}

Eigen::VectorXd ContactTrajectory::velocity() const {
  return linear_.velocity() + owner_.reduced().basis() * (linear_.modes()->shapes * state_.col(1));
}

Eigen::VectorXd ContactTrajectory::output() const {
  Eigen::VectorXd out(owner_.model().output_size());
  out.tail(reactions_.size()) = linear_.reactions() + reactions_;
  const Eigen::Index dofs = owner_.model().fem().dof_count();
  if (owner_.gives_forces_alone()) {
    out.head(dofs).setZero();
  } else {
    out.head(dofs) = displacement();
  }
  return out;
}

}  // namespace tissue_stiffness
