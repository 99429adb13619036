#include "forward/reduced_model.hpp"

#include <algorithm>
#include <cmath>

#include "fem/generalized_modes.hpp"
#include "forward/reduced_trajectory.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr std::size_t kKept = 16;  // modes of the last theta
constexpr int kBits = 44;          // of proportions

Eigen::MatrixXd chosen(const Eigen::MatrixXd& m, const std::vector<int>& rows, const std::vector<int>& columns) {
  Eigen::MatrixXd part(static_cast<Eigen::Index>(rows.size()), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      part(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = m(rows[i], columns[j]);
    }
  }
  return part;
}

// Divides the coefficients by the size of the first that is not zero, and returns this size, or 1 where there is none. They
// are rounded, because equal proportions may differ in their last bits.
double divide_by_first(std::vector<double>& coefficients) {
  const auto first = std::find_if(coefficients.begin(), coefficients.end(), [](double c) { return c != 0.0; });
  if (first == coefficients.end()) return 1.0;
  const double scale = std::abs(*first);
  for (double& c : coefficients) {
    int exponent = 0;
    const double digits = std::frexp(c / scale, &exponent);
    c = std::ldexp(std::nearbyint(std::ldexp(digits, kBits)), exponent - kBits);
  }
  return scale;
}

// Returns the modes of mass * M + inertia * (stiffness * K) and stiffness * K, given those of M and K. The shapes stay.
ReducedModes scaled(const ReducedModes& of, double mass, double stiffness, double inertia) {
  ReducedModes out;
  out.stiffness_inertia = inertia;
  const Eigen::VectorXd modal_mass = mass + inertia * stiffness * of.square.array();
  const Eigen::VectorXd root = modal_mass.cwiseSqrt();
  out.square = stiffness * of.square.cwiseQuotient(modal_mass);
  out.shapes = of.shapes * root.cwiseInverse().asDiagonal();
  out.to_modal = root.asDiagonal() * of.to_modal;
  out.weight = mass * root.cwiseInverse().asDiagonal() * of.weight;
  out.momentum = mass * root.cwiseInverse().asDiagonal() * of.momentum;
  return out;
}

}  // namespace

ReducedModel::ReducedModel(const Model& model, const BasisOptions& options, const ReducedModel* relative)
    : model_(model), options_(options) {
  if (model.nonlinear() && options.nonlinear == BasisOptions::Nonlinear::in_full) {
    throw InputError("model", "a nonlinear effect", "linear effects only, in a reduced basis");
  }
  basis_ = options.adopt && relative != nullptr
               ? adopted(*relative)
               : build_reduced_basis(model, options, relative != nullptr ? relative->basis_.root : nullptr);
  if (!options.keep_root) basis_.root = nullptr;
  for (const auto& part : model.parts()) projected_.emplace_back(part.terms);
  if (options.adopt && relative != nullptr && basis_.vectors.cols() == relative->basis_.vectors.cols()) {
    adopt_projections(*relative);
  }
  project();
  project_reactions();
}

void ReducedModel::add_strain_stiffness(std::size_t part, std::size_t term, double coefficient,
                                        const Eigen::VectorXd& parameters, Eigen::MatrixXd& sum) const {
  if (coefficient == 0.0) return;
  const Eigen::MatrixXd& constant = projected_[part].strain_stiffness[term];
  if (constant.size() > 0) {
    sum += coefficient * constant;
  } else {
    sum += coefficient * *shaped(model_.parts()[part].terms.strain_stiffness[term], parameters);
  }
}

// Returns the stiffness in the basis without springs that do not relax.
Eigen::MatrixXd ReducedModel::relaxing_stiffness(const Eigen::VectorXd& theta) const {
  const Eigen::Index m = basis_.vectors.cols();
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, m);
  for (std::size_t i = 0; i < projected_.size(); ++i) {
    const LinearTerms& terms = model_.parts()[i].terms;
    const Eigen::VectorXd p = model_.parts()[i].parameters(theta);
    for (std::size_t k = 0; k < terms.stiffness.size(); ++k) {
      if (terms.stiffness[k].relaxes) sum += terms.stiffness[k].coefficient(p) * projected_[i].stiffness[k];
    }
    for (std::size_t k = 0; k < terms.strain_stiffness.size(); ++k) {
      add_strain_stiffness(i, k, terms.strain_stiffness[k].coefficient(p), p, sum);
    }
  }
  return sum;
}

ReactionRows ReducedModel::reaction_rows(const Eigen::VectorXd& theta, const ReducedModes& modes) const {
  const std::vector<Model::Reaction>& reactions = model_.reactions();
  ReactionRows out;
  if (reactions.empty()) return out;
  out.lift = modes.shapes.transpose() * reaction_springs_;
  for (std::size_t r = 0; r < reactions.size(); ++r) {
    const Model::Part& part = model_.parts()[reactions[r].part];
    if (part.terms.stiffness.empty()) continue;  // a tool's contact is left out, as is its reaction
    out.lift.middleCols<3>(3 * static_cast<Eigen::Index>(r)) *=
        part.terms.stiffness.front().coefficient(part.parameters(theta));
  }
  for (Eigen::Index m = 0; m < out.lift.rows(); ++m) {
    modes.square[m] > 0.0 ? out.lift.row(m) /= modes.square[m] : out.lift.row(m).setZero();
  }
  out.elastic = modes.shapes.transpose() * (relaxing_stiffness(theta) * (modes.shapes * out.lift));
  return out;
}

std::unique_ptr<ReducedModel> ReducedModel::grown() const {
  BasisOptions options = options_;
  ++options.growths;
  options.adopt = false;
  auto out = std::make_unique<ReducedModel>(model_, options, this);
  if (out->basis_.vectors.cols() <= basis_.vectors.cols()) return nullptr;
  out->restrict_output_to(output_.nodes());
  return out;
}

std::vector<int> ReducedModel::active(const Eigen::VectorXd& theta, bool half) const {
  std::vector<int> columns;
  for (std::size_t i = 0; i < basis_.support.size(); ++i) {
    if (half && basis_.late[i] != 0) continue;
    const int support = basis_.support[i];
    if (support >= 0) {
      const auto& part = model_.parts()[static_cast<std::size_t>(support)];
      if (!part.is_compliant(part.parameters(theta))) continue;
    }
    columns.push_back(static_cast<int>(i));
  }
  return columns;
}

ReducedModel::Proportions ReducedModel::proportions(const Eigen::VectorXd& theta, bool half) const {
  Proportions out;
  out.others.push_back(half ? 1.0 : 0.0);
  for (const auto& part : model_.parts()) {
    const LinearTerms& terms = part.terms;
    if (terms.mass.empty() && terms.stiffness.empty() && terms.strain_stiffness.empty()) continue;
    const Eigen::VectorXd p = part.parameters(theta);
    for (const auto& term : terms.mass) out.masses.push_back(term.coefficient(p));
    for (const auto& term : terms.stiffness) out.stiffnesses.push_back(term.coefficient(p));
    for (const auto& term : terms.strain_stiffness) {
      const double c = term.coefficient(p);
      out.stiffnesses.push_back(c);
      for (const int i : term.shape) out.others.push_back(c == 0.0 ? 0.0 : p[i]);
    }
    out.others.push_back(part.is_compliant(p) ? 1.0 : 0.0);
  }
  out.mass = divide_by_first(out.masses);
  out.stiffness = divide_by_first(out.stiffnesses);
  return out;
}

std::shared_ptr<const ReducedModes> ReducedModel::modes(const Eigen::VectorXd& theta, bool half) const {
  const Proportions wanted = proportions(theta, half);
  const std::shared_ptr<const ReducedModes> unit = unit_modes(wanted, theta, half);
  return std::make_shared<ReducedModes>(
      scaled(*unit, model_.mass_factor(theta) * wanted.mass, wanted.stiffness, model_.stiffness_inertia(theta)));
}

std::shared_ptr<const ReducedModes> ReducedModel::unit_modes(const Proportions& proportions, const Eigen::VectorXd& theta,
                                                             bool half) const {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Known& known : known_) {
      if (known.proportions.same_shapes(proportions)) return known.modes;
    }
  }
  auto modes = std::make_shared<const ReducedModes>(solve(proportions, theta, half));
  const std::lock_guard<std::mutex> lock(mutex_);
  if (known_.size() == kKept) known_.erase(known_.begin());
  known_.push_back({proportions, modes});
  return modes;
}

std::shared_ptr<const Eigen::MatrixXd> ReducedModel::shaped(const StrainTerm& term,
                                                            const Eigen::VectorXd& parameters) const {
  Eigen::VectorXd shape(static_cast<Eigen::Index>(term.shape.size()));
  for (std::size_t i = 0; i < term.shape.size(); ++i) shape[static_cast<Eigen::Index>(i)] = parameters[term.shape[i]];
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (const Shaped& known : shaped_) {
      if (known.term == &term && known.shape == shape) return known.projected;
    }
  }
  const Eigen::MatrixXd projected = project_strain_stiffness(model_.fem(), term.at(parameters), strains_);
  const std::lock_guard<std::mutex> lock(mutex_);
  if (shaped_.size() == kKept) shaped_.erase(shaped_.begin());
  shaped_.push_back({&term, std::move(shape), std::make_shared<const Eigen::MatrixXd>(projected)});
  return shaped_.back().projected;
}

ReducedModes ReducedModel::solve(const Proportions& proportions, const Eigen::VectorXd& theta, bool half) const {
  const Eigen::Index m = basis_.vectors.cols();
  Eigen::MatrixXd mass = Eigen::MatrixXd::Zero(m, m), stiffness = mass;
  ReducedModes modes;
  modes.weight = modes.momentum = Eigen::MatrixX3d::Zero(m, 3);
  auto next_mass = proportions.masses.begin(), next_stiffness = proportions.stiffnesses.begin();
  for (std::size_t i = 0; i < projected_.size(); ++i) {
    const Projected& part = projected_[i];
    const Eigen::VectorXd p = model_.parts()[i].parameters(theta);
    for (std::size_t k = 0; k < part.mass.size(); ++k) {
      const double c = *next_mass++;
      if (c == 0.0) continue;
      mass += c * part.mass[k];
      modes.weight += c * part.weight[k];
      modes.momentum += c * part.momentum[k];
    }
    for (std::size_t k = 0; k < part.stiffness.size(); ++k) {
      const double c = *next_stiffness++;
      if (c != 0.0) stiffness += c * part.stiffness[k];
    }
    for (std::size_t k = 0; k < part.strain_stiffness.size(); ++k) {
      add_strain_stiffness(i, k, *next_stiffness++, p, stiffness);
    }
  }
  const std::vector<int> columns = active(theta, half);
  const GeneralizedModes found = generalized_modes(chosen(stiffness, columns, columns), chosen(mass, columns, columns));
  modes.square = found.values.cwiseMax(0.0);
  modes.shapes = Eigen::MatrixXd::Zero(m, found.vectors.cols());
  for (std::size_t i = 0; i < columns.size(); ++i) {
    modes.shapes.row(columns[i]) = found.vectors.row(static_cast<Eigen::Index>(i));
  }
  modes.to_modal = modes.shapes.transpose() * mass;
  modes.weight = modes.shapes.transpose() * modes.weight;
  modes.momentum = modes.shapes.transpose() * modes.momentum;
  return modes;
}

Eigen::VectorXd ReducedModel::load(std::size_t part, std::size_t term, const Eigen::VectorXd& parameters) const {
  const LoadTerm& load = model_.parts()[part].terms.loads[term];
  return load.shaped ? Eigen::VectorXd(basis_.vectors.transpose() * load.shaped(parameters)) : projected_[part].loads[term];
}

std::unique_ptr<Trajectory> ReducedModel::start(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<ReducedTrajectory>(*this, theta, start);
}

std::unique_ptr<Trajectory> ReducedModel::resume(const Eigen::VectorXd& theta, const Trajectory& from) const {
  return std::make_unique<ReducedTrajectory>(*this, theta, dynamic_cast<const ReducedTrajectory&>(from));
}

std::unique_ptr<Trajectories> ReducedModel::resume_all(const std::vector<Eigen::VectorXd>& thetas,
                                                       const Trajectory& from) const {
  return std::make_unique<ReducedTrajectories>(*this, resume_each(thetas, from));
}

std::unique_ptr<Trajectory> ReducedModel::start_in_half(const Eigen::VectorXd& theta, double start) const {
  return std::make_unique<ReducedTrajectory>(*this, theta, start, true);
}

std::unique_ptr<Trajectories> ReducedModel::start_all(const std::vector<Eigen::VectorXd>& thetas, double start) const {
  return std::make_unique<ReducedTrajectories>(*this, start_each(thetas, start));
}

void ReducedModel::advance_through(Trajectory& run, const std::vector<double>& times, const Show& show) const {
  show_together(dynamic_cast<ReducedTrajectory&>(run), times, show);
}

Eigen::MatrixXd ReducedModel::basis_at(const std::vector<int>& nodes) const {
  return basis_rows(basis_.vectors, nodes);
}

const Eigen::MatrixXd& ReducedModel::start_shapes() const {
  std::call_once(start_shapes_found_, [this] {
    const std::shared_ptr<const ReducedModes> at_prior = modes(model_.prior_theta());
    const Eigen::VectorXd flexibility = at_prior->flexibility();
    Eigen::MatrixXd modal(flexibility.size(), 6);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::VectorXd first = flexibility.cwiseProduct(at_prior->weight.col(axis));
      const Eigen::VectorXd second = flexibility.cwiseProduct(first);
      modal.col(axis) = first;
      modal.col(3 + axis) = second - first.dot(second) / first.squaredNorm() * first;
    }
    start_shapes_ = at_prior->shapes * modal;
    for (Eigen::Index k = 0; k < start_shapes_.cols(); ++k) {
      const Eigen::VectorXd u = basis_.vectors * start_shapes_.col(k);
      start_shapes_.col(k) /=
          std::sqrt(Eigen::Map<const Eigen::Matrix3Xd>(u.data(), 3, u.size() / 3).colwise().squaredNorm().maxCoeff());
    }
  });
  return start_shapes_;
}

void ReducedModel::restrict_output_to(const OutputNodes& nodes) {
  output_.restrict_to(basis_.vectors, nodes);
}

Eigen::VectorXd ReducedModel::displacement(const Eigen::VectorXd& coordinates) const {
  Eigen::MatrixXd u = Eigen::VectorXd::Zero(basis_.vectors.rows());
  displacements(coordinates, u);
  return u;
}

void ReducedModel::displacements(const Eigen::MatrixXd& coordinates, Eigen::MatrixXd& out) const {
  output_.displacements(basis_.vectors, coordinates, out);
}

void ReducedModel::recover(const Eigen::VectorXd& coordinates, Eigen::Ref<Eigen::VectorXd> displacement) const {
  multiply_tall(basis_.vectors, coordinates, displacement);
}

std::string ReducedModel::description() const {
  return "reduced: " + std::to_string(basis_.vectors.cols()) + " load-dependent Ritz vectors for " +
         std::to_string(basis_.vectors.rows()) + " degrees of freedom, exact in time";
}

}  // namespace tissue_stiffness
