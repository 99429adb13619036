#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <mutex>
#include <vector>

#include "forward/forward_model.hpp"
#include "forward/output_rows.hpp"
#include "forward/reduced_basis.hpp"

namespace tissue_stiffness {

/// Free vibrations of a reduced model at one theta: (K - omega^2 M) phi = 0.
struct ReducedModes {
  Eigen::MatrixXd shapes;          ///< each mode in basis coordinates, basis size x modes, M-orthonormal
  Eigen::MatrixXd to_modal;        ///< from basis coordinates to modal coordinates, modes x basis size
  Eigen::VectorXd square;          ///< omega^2, ascending [rad^2/s^2]
  Eigen::MatrixX3d weight;         ///< modal force of a unit body acceleration along each axis
  Eigen::MatrixX3d momentum;       ///< modal velocity of a unit initial velocity of the nodes that are not held
  double stiffness_inertia = 0.0;  ///< gamma, if M is that of the body plus gamma K [s^2]

  /// Returns 1 / omega^2 of the modes that deform the body, and 0 for those that move it as a whole.
  Eigen::VectorXd flexibility() const {
    return (square.array() > kRigid * square.maxCoeff()).select(square.cwiseInverse(), 0.0);
  }
  static constexpr double kRigid = 1e-12;

  /// Returns the modal value of alpha M_body + beta K [1/s].
  Eigen::ArrayXd damping(double alpha, double beta) const {
    return alpha + (beta - alpha * stiffness_inertia) * square.array();
  }
};

/// The reaction to a region's prescribed motion is the virtual work of all else on psi, the static response of the body to
/// a unit motion of the region along an axis:
///   F = psi . (M u'' + alpha M u' + K (u + beta u' + sum gamma (u - z)) - f),  K without the springs of the region.
/// Unlike the springs' own force it is no difference of large numbers.
struct ReactionRows {
  Eigen::MatrixXd lift;     ///< psi of each axis of each reaction in modal coordinates, modes x 3 for each
  Eigen::MatrixXd elastic;  ///< K psi, likewise [N/m]
};

/// A linear model in a basis of load-dependent Ritz vectors. In the basis every step is exact for loads that are linear in
/// time (modal superposition). So the time step causes no error. Terms whose place or angle is estimated are projected
/// again for each theta. Thread safe.
class ReducedModel : public ForwardModel {
 public:
  /// `relative`: a model of the same body. The root of its basis is reused where it is identical, or its whole basis if the
  /// options say so. Throws InputError for a model that nothing moves, and for a nonlinear one that is to be simulated in
  /// full.
  explicit ReducedModel(const Model& model, const BasisOptions& options = {}, const ReducedModel* relative = nullptr);

  std::unique_ptr<Trajectory> start(const Eigen::VectorXd& theta, double start) const override;
  /// Starts runs whose displacements are recovered together.
  std::unique_ptr<Trajectories> start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const override;
  std::unique_ptr<Trajectory> resume(const Eigen::VectorXd& theta, const Trajectory& from) const override;
  std::unique_ptr<Trajectories> resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                           const Trajectory& from) const override;
  /// Starts a run in the earlier half of the basis. The change due to the later half indicates the error of the whole
  /// basis.
  std::unique_ptr<Trajectory> start_in_half(const Eigen::VectorXd& theta, double start) const;
  /// Returns the model in a basis larger by half; null when that adds no vectors.
  std::unique_ptr<ReducedModel> grown() const;
  void advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const override;
  void restrict_output_to(const OutputNodes& nodes) override;
  const OutputNodes& output_nodes() const { return output_.nodes(); }
  std::string description() const override;

  const Model& model() const { return model_; }
  /// Returns the basis, 3n x basis size.
  const Eigen::MatrixXd& basis() const { return basis_.vectors; }
  /// Returns the basis at some nodes, three rows for each.
  Eigen::MatrixXd basis_at(const std::vector<int>& nodes) const;
  /// Returns the nodal displacement of basis coordinates, 3n. It is zero at nodes that the output does not hold.
  Eigen::VectorXd displacement(const Eigen::VectorXd& coordinates) const;
  /// Returns six smooth motions in basis coordinates, basis size x 6, that the body may have at the start: a_i ~ K^-1 M 1_i
  /// for the three axes i, and b_i, what of K^-1 M a_i is M-orthogonal to a_i. K and M are those of the prior. The largest
  /// displacement of each is 1.
  const Eigen::MatrixXd& start_shapes() const;
  /// Returns how the reactions follow from the motion of the modes at theta.
  ReactionRows reaction_rows(const Eigen::VectorXd& theta, const ReducedModes& modes) const;
  /// Computes the displacements of several columns of coordinates. They are written to those rows of `out` that belong to
  /// the output; other rows are not changed.
  void displacements(const Eigen::MatrixXd& coordinates, Eigen::MatrixXd& out) const;
  /// Shows a run that has coordinates(). Many instants are processed together, so that the basis is read from memory only a
  /// few times.
  template <typename Run>
  void show_together(Run& run, const std::vector<double>& times, const Show& show) const;
  /// Computes the displacement of every node, even if the output is restricted.
  void recover(const Eigen::VectorXd& coordinates, Eigen::Ref<Eigen::VectorXd> displacement) const;
  /// Returns the modes at theta. The last few are kept. They are solved again for theta that differ in more than the scale
  /// of the mass, the scale of the stiffness, or the stiffness' inertia. `half`: in the earlier half of the basis.
  std::shared_ptr<const ReducedModes> modes(const Eigen::VectorXd& theta, bool half = false) const;
  /// Returns the basis coordinates of a load term's pattern.
  Eigen::VectorXd load(std::size_t part, std::size_t term, const Eigen::VectorXd& parameters) const;

 private:
  struct Projected {
    explicit Projected(const LinearTerms& terms)
        : mass(terms.mass.size()), stiffness(terms.stiffness.size()), strain_stiffness(terms.strain_stiffness.size()) {}
    std::vector<Eigen::MatrixXd> mass, stiffness, strain_stiffness;  ///< strain_stiffness: empty where it depends on theta
    std::vector<Eigen::VectorXd> loads;
    std::vector<Eigen::MatrixX3d> weight, momentum;  ///< each mass term times a unit motion along each axis
  };
  /// Mass and stiffness relative to the sizes of the first coefficients of their terms.
  struct Proportions {
    double mass = 1.0, stiffness = 1.0;       ///< these sizes
    std::vector<double> masses, stiffnesses;  ///< every term's coefficient over these sizes
    std::vector<double> others;               ///< all other numbers on which mode shapes depend

    bool same_shapes(const Proportions& other) const {
      return masses == other.masses && stiffnesses == other.stiffnesses && others == other.others;
    }
  };
  struct Known {
    Proportions proportions;
    std::shared_ptr<const ReducedModes> modes;
  };
  struct Shaped {
    const StrainTerm* term;
    Eigen::VectorXd shape;
    std::shared_ptr<const Eigen::MatrixXd> projected;
  };
  ReducedBasis adopted(const ReducedModel& relative) const;
  std::shared_ptr<const Eigen::MatrixXd> shaped(const StrainTerm& term, const Eigen::VectorXd& parameters) const;
  void project();
  void project_part(std::size_t part);
  void project_reactions();
  /// Copies a relative's projections onto the same vectors.
  void adopt_projections(const ReducedModel& relative);
  void adopt_projections(std::size_t part, const ReducedModel& relative);
  Proportions proportions(const Eigen::VectorXd& theta, bool half) const;
  /// Adds one strain term's stiffness times its coefficient; its shape may depend on the part's parameters.
  void add_strain_stiffness(std::size_t part, std::size_t term, double coefficient, const Eigen::VectorXd& parameters,
                            Eigen::MatrixXd& sum) const;
  Eigen::MatrixXd relaxing_stiffness(const Eigen::VectorXd& theta) const;
  std::vector<int> active(const Eigen::VectorXd& theta, bool half) const;
  /// Returns the modes of masses and stiffnesses in these proportions, without inertia of the stiffness.
  std::shared_ptr<const ReducedModes> unit_modes(const Proportions& proportions, const Eigen::VectorXd& theta,
                                                 bool half) const;
  ReducedModes solve(const Proportions& proportions, const Eigen::VectorXd& theta, bool half) const;

  const Model& model_;
  BasisOptions options_;
  ReducedBasis basis_;
  OutputRows output_;
  Eigen::MatrixXd reaction_springs_;  ///< for a unit coefficient, basis size x 3 for each reaction
  std::vector<Projected> projected_;  ///< one for each part
  StrainRows strains_;                ///< strains of the basis, if a term needs them for each theta
  mutable std::once_flag start_shapes_found_;
  mutable Eigen::MatrixXd start_shapes_;
  mutable std::mutex mutex_;
  mutable std::vector<Known> known_;
  mutable std::vector<Shaped> shaped_;  ///< the last few projections of terms whose place or angle is estimated
};

template <typename Run>
void ReducedModel::show_together(Run& run, const std::vector<double>& times, const Show& show) const {
  constexpr std::size_t at_once = 16;
  Eigen::MatrixXd coordinates(basis_.vectors.cols(), at_once);
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(model_.output_size(), at_once);
  for (std::size_t first = 0; first < times.size(); first += at_once) {
    const std::size_t count = std::min(at_once, times.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      run.advance(times[first + i]);
      coordinates.col(static_cast<Eigen::Index>(i)) = run.coordinates();
      u.col(static_cast<Eigen::Index>(i)).tail(u.rows() - basis_.vectors.rows()) = run.reactions();
    }
    displacements(coordinates.leftCols(static_cast<Eigen::Index>(count)), u);
    for (std::size_t i = 0; i < count; ++i) show(first + i, u.col(static_cast<Eigen::Index>(i)));
  }
}

}  // namespace tissue_stiffness
