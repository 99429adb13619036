#include "forward/contact_trajectory.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "forward/force_steps.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kSettled = 1e-9;  // body sizes
constexpr int kMostIterations = 60;
constexpr double kCut = 0.4, kLeastCut = 0.01;  // of a step
constexpr double kCloser = 0.95;                // what a step has to leave of the distance
constexpr double kTravel = 0.005;               // of a tool's size, in a step
constexpr double kSameSpan = 1e-9;              // of a step

Eigen::MatrixXd rows_of(const Eigen::MatrixXd& m, const std::vector<int>& rows) {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(rows.size()), m.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) out.row(static_cast<Eigen::Index>(i)) = m.row(rows[i]);
  return out;
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
  modal_force_ = shapes_.transpose() * force_;
  stretch_ = from.stretch_;
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
      modal_force_(Eigen::VectorXd::Zero(softness_.size())),
      stretch_(Eigen::VectorXd::Zero(shapes_.rows())),
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
  out.memory = stiffness_damping_ / out.span * stretch_;
  out.resistance = 1.0 + stiffness_damping_ / out.span;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const RelaxationStep relaxing(branches_[b], out.span);
    const double gamma = branches_[b].modulus;
    out.resistance += gamma * (1.0 - relaxing.to);
    out.memory += gamma * (relaxing.decay * relaxed_.col(static_cast<Eigen::Index>(b)) + relaxing.from * stretch_);
  }
  std::vector<int> remembered;
  for (Eigen::Index i = 0; i < out.memory.size(); ++i) {
    if (out.memory[i] != 0.0) remembered.push_back(static_cast<int>(i));
  }
  if (remembered.empty()) return out;
  const Eigen::VectorXd memory = rows_of(out.memory, remembered);
  const Eigen::MatrixXd shapes = rows_of(shapes_, remembered);
  const Eigen::VectorXd residual = flexibility_.unit->under(remembered, memory) / flexibility_.ratio -
                                   shapes_ * softness_.cwiseProduct(shapes.transpose() * memory);
  out.free += residual / out.resistance;
  return out;
}

const Eigen::MatrixXd& ContactTrajectory::response_between(const Step& step, const std::vector<int>& forced) {
  if (response_.forced == forced && std::abs(response_.span - step.span) < kSameSpan * step.span) return response_.between;
  const Eigen::MatrixXd shapes = rows_of(shapes_, forced);
  const Eigen::VectorXd modal = step.modal - softness_ / step.resistance;
  response_ = {forced, step.span,
               flexibility_.unit->between(forced) / (flexibility_.ratio * step.resistance) +
                   shapes * (modal.asDiagonal() * shapes.transpose())};
  return response_.between;
}

Eigen::VectorXd ContactTrajectory::response(const Step& step, const std::vector<int>& forced,
                                            const Eigen::VectorXd& forces) const {
  const Eigen::VectorXd modal =
      (step.modal - softness_ / step.resistance).cwiseProduct(rows_of(shapes_, forced).transpose() * forces);
  return flexibility_.unit->under(forced, forces) / (flexibility_.ratio * step.resistance) + shapes_ * modal;
}

ContactTrajectory::Forces ContactTrajectory::forces_at(const Step& step, Eigen::VectorXd u) {
  const std::vector<int>& dofs = owner_.dofs();
  for (std::size_t i = 0; i < dofs.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    displacement_[dofs[i]] = u[k];
    velocity_[dofs[i]] = (u[k] - at_[k]) / step.span;
  }
  Forces out;
  out.u = std::move(u);
  out.nodal = Eigen::VectorXd::Zero(out.u.size());
  out.reactions = Eigen::VectorXd::Zero(reactions_.size());
  std::vector<Contact::Touch> touches;
  for (const Part& part : parts_) {
    const std::size_t first = touches.size();
    part.contact->find({step.time, displacement_, velocity_}, part.parameters, touches);
    for (std::size_t t = first; t < touches.size() && part.reaction >= 0; ++t) {
      out.reactions.segment<3>(part.reaction) += touches[t].force;
    }
  }
  add_touches(touches, step.span, out);
  out.off = out.u - step.free - response(step, out.touched, rows_of(out.nodal, out.touched));
  return out;
}

void ContactTrajectory::add_touches(const std::vector<Contact::Touch>& touches, double span, Forces& out) const {
  std::set<int> touched;
  for (const Contact::Touch& touch : touches) {
    for (Eigen::Index a = 0; a < touch.nodes.size(); ++a) {
      const int place = owner_.place(touch.nodes[a]);
      out.nodal.segment<3>(place) += touch.shape[a] * touch.force;
      touched.insert({place, place + 1, place + 2});
    }
  }
  out.touched.assign(touched.begin(), touched.end());
  std::vector<int> index(owner_.dofs().size(), -1);
  for (std::size_t i = 0; i < out.touched.size(); ++i)
    index[static_cast<std::size_t>(out.touched[i])] = static_cast<int>(i);
  const auto count = static_cast<Eigen::Index>(out.touched.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const Contact::Touch& touch : touches) {
    const Eigen::Matrix3d tangent = touch.stiffness + touch.damping / span;
    for (Eigen::Index a = 0; a < touch.nodes.size(); ++a) {
      const int row = index[static_cast<std::size_t>(owner_.place(touch.nodes[a]))];
      for (Eigen::Index b = 0; b < touch.nodes.size(); ++b) {
        const int column = index[static_cast<std::size_t>(owner_.place(touch.nodes[b]))];
        const Eigen::Matrix3d block = touch.shape[a] * touch.shape[b] * tangent;
        for (int i = 0; i < 3; ++i) {
          for (int j = 0; j < 3; ++j) entries.emplace_back(row + i, column + j, block(i, j));
        }
      }
    }
  }
  out.stiffness.resize(count, count);
  out.stiffness.setFromTriplets(entries.begin(), entries.end());
}

// Newton's method for u = free + H f(u), with f linearised at the last u: (1 + K H) f = f(u) - K (free - u). A step is cut
// while it does not bring the two sides closer.
void ContactTrajectory::step(double time) {
  const Step step = begin_step(time);
  const double tolerance = kSettled * body_size(owner_.model().mesh().nodes);
  Forces now = forces_at(step, at_);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (now.off.cwiseAbs().maxCoeff() < tolerance) return end_step(step, now);
    Eigen::VectorXd next = step.free;
    if (!now.touched.empty()) {
      const SparseMatrix& k = now.stiffness;
      Eigen::MatrixXd left = k * response_between(step, now.touched);
      left.diagonal().array() += 1.0;
      const Eigen::VectorXd right = rows_of(now.nodal, now.touched) - k * rows_of(step.free - now.u, now.touched);
      next += response(step, now.touched, left.partialPivLu().solve(right));
    }
    if (!next.allFinite()) break;
    const Eigen::VectorXd change = next - now.u;
    Forces best = forces_at(step, next);
    for (double share = kCut; share > kLeastCut && best.off.norm() > kCloser * now.off.norm(); share *= kCut) {
      Forces other = forces_at(step, now.u + share * change);
      if (other.off.norm() < best.off.norm()) best = std::move(other);
    }
    now = std::move(best);
  }
  throw NumericalError("the contact does not settle within a step of " + std::to_string(step.span) + " s");
}

void ContactTrajectory::end_step(const Step& step, const Forces& forces) {
  const Eigen::VectorXd modal = shapes_.transpose() * forces.nodal;
  modal_step_.advance(step.span, modal_force_, modal, state_);
  force_ = forces.nodal;
  modal_force_ = modal;
  const Eigen::VectorXd stretch = (forces.nodal + step.memory) / step.resistance;
  for (std::size_t b = 0; b < branches_.size(); ++b) {
    const RelaxationStep relaxing(branches_[b], step.span);
    auto z = relaxed_.col(static_cast<Eigen::Index>(b));
    z = (relaxing.decay * z + relaxing.from * stretch_ + relaxing.to * stretch).eval();
  }
  stretch_ = stretch;
  for (std::size_t i = 0; i < owner_.dofs().size(); ++i)
    at_[static_cast<Eigen::Index>(i)] = displacement_[owner_.dofs()[i]];
  reactions_ = forces.reactions;
}

Eigen::VectorXd ContactTrajectory::coordinates() const {
  const Eigen::VectorXd own = state_.col(0) - softness_.cwiseProduct(shapes_.transpose() * stretch_);
  return linear_.coordinates() + linear_.modes()->shapes * own;
}

Eigen::VectorXd ContactTrajectory::displacement() const {
  Eigen::VectorXd u = owner_.reduced().displacement(coordinates());
  if (!stretch_.isZero(0.0)) u += flexibility_.unit->response(stretch_) / flexibility_.ratio;
  return u;
}

Eigen::VectorXd ContactTrajectory::velocity() const {
  return linear_.velocity() + owner_.reduced().basis() * (linear_.modes()->shapes * state_.col(1));
}

Eigen::VectorXd ContactTrajectory::output() const {
  Eigen::VectorXd out(owner_.model().output_size());
  out << displacement(), linear_.reactions() + reactions_;
  return out;
}

}  // namespace tissue_stiffness
