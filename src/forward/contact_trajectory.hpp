#pragma once

#include <Eigen/Core>
#include <optional>
#include <utility>
#include <vector>

#include "forward/contact_model.hpp"
#include "forward/reduced_trajectory.hpp"

namespace tissue_stiffness {

/// A run of a ContactModel. Over a step the contacts' forces change linearly, and they balance at its end.
class ContactTrajectory : public Trajectory {
 public:
  ContactTrajectory(const ContactModel& owner, const Eigen::VectorXd& theta, double start);
  /// Continues another run of the same model with other parameters.
  ContactTrajectory(const ContactModel& owner, const Eigen::VectorXd& theta, const ContactTrajectory& from);

  /// Throws NumericalError where a step's contact does not settle.
  void advance(double time) override;
  double time() const override { return linear_.time(); }
  Eigen::VectorXd displacement() const override;
  Eigen::VectorXd velocity() const override;
  Eigen::VectorXd output() const override;

 private:
  struct Part {
    const Contact* contact;
    Eigen::VectorXd parameters;
    Eigen::Index reaction;  ///< its first row among the reactions; -1: no sensor may measure it
  };
  /// What the body does over a step without the contacts' new forces, and how it responds to them.
  struct Step {
    double time, span;
    Eigen::MatrixXd modes;   ///< state at the end
    Eigen::VectorXd free;    ///< displacement of the nodes that may touch
    Eigen::VectorXd modal;   ///< displacement of each mode by a unit force at the end
    Eigen::VectorXd memory;  ///< force that the residual response remembers, b in a s = f + b
    double resistance;       ///< a
  };
  /// The contacts' forces at a displacement u.
  struct Contacts {
    Eigen::VectorXd u;         ///< at dofs() [m]
    Eigen::VectorXd nodal;     ///< at dofs() [N]
    std::vector<int> touched;  ///< indices into dofs(), ascending
    std::vector<Contact::Touch> touches;
    Eigen::VectorXd reactions;  ///< [N]
  };
  /// A step of Newton's method: forces f at dofs() [N], and by how much u changes with them [m].
  struct NewtonStep {
    Eigen::VectorXd forces, change;
  };
  enum class Tangent { exact, convex };
  ContactTrajectory(const ContactModel& owner, const Eigen::VectorXd& theta, ReducedTrajectory linear);
  int steps_to(double time) const;
  void step(double time);
  Step begin_step(double time);
  Contacts contacts_at(const Step& step, Eigen::VectorXd u);
  /// Returns nothing where the tangent is not positive definite along a direction. `forces`: from where it is solved.
  std::optional<NewtonStep> newton_step(const Step& step, const Contacts& contacts, const Eigen::VectorXd& forces,
                                        Tangent tangent);
  Contacts search(const Step& step, const Contacts& from, Eigen::VectorXd& forces, const NewtonStep& newton);
  /// H is the response to the contacts' forces at the step's end. Returns H f at all of dofs() under forces at some [m].
  Eigen::VectorXd response(const Step& step, const std::vector<int>& forced, const Eigen::VectorXd& forces) const;
  void end_step(const Step& step, const Contacts& contacts);
  Eigen::VectorXd coordinates() const;

  const ContactModel& owner_;
  ReducedTrajectory linear_;  ///< the run without contact
  ContactModel::Flexibility flexibility_;
  std::vector<Part> parts_;
  double stiffness_damping_;  ///< beta [s]
  std::vector<Relaxation> branches_;
  Eigen::MatrixXd shapes_;    ///< modes at dofs()
  Eigen::VectorXd softness_;  ///< Omega^-2 of each mode
  ModalStep modal_step_;
  Eigen::MatrixXd state_;       ///< response of the modes to the contacts: columns q, q', z...
  Eigen::VectorXd force_;       ///< of the contacts at dofs() [N]
  Eigen::VectorXd force_rate_;  ///< over the last step [N/s]
  Eigen::VectorXd modal_force_;
  Eigen::VectorXd stretch_;         ///< s at dofs() [N]
  Eigen::VectorXd stretch_before_;  ///< a step earlier [N]
  double span_before_ = 0.0;        ///< of the last step; 0: none [s]
  Eigen::MatrixXd relaxed_;         ///< z of each branch at dofs() [N]
  Eigen::VectorXd at_;              ///< displacement at dofs() [m]
  Eigen::VectorXd reactions_;       ///< of the last step [N]
  /// What the response between touched nodes needs. The tool often touches the same nodes in the next step.
  struct Touched {
    std::vector<int> dofs;   ///< indices into dofs()
    Eigen::MatrixXd unit;    ///< static response between them, that of flexibility_.unit [m/N]
    Eigen::MatrixXd shapes;  ///< of the modes there
  } touched_;
  const Touched& touched(const std::vector<int>& dofs);
  Eigen::VectorXd displacement_, velocity_;  ///< of all nodes, for the contacts: zero at other nodes than theirs
};

}  // namespace tissue_stiffness
