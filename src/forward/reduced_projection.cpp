// The terms of a model, projected onto its basis.
#include <tbb/parallel_for.h>

#include <algorithm>

#include "forward/project_matrix.hpp"
#include "forward/reduced_model.hpp"

namespace tissue_stiffness {
namespace {

Eigen::VectorXd prior_parameters(const Model& model, const Model::Part& part) {
  return part.parameters(model.parameters().theta(model.parameters().prior_mean()));
}

bool same_matrix(const Discretisation& fem, const StrainFactorField& a, const StrainFactorField& b) {
  for (int e = 0; e < fem.element_count(); ++e) {
    for (int q = 0; q < fem.points_per_element(); ++q) {
      const StrainFactor one = a(e, q), other = b(e, q);
      if (one.cols() != other.cols() || one != other) return false;
    }
  }
  return true;
}

}  // namespace

// Returns the relative's vectors, except those of supports that this model does not have.
ReducedBasis ReducedModel::adopted(const ReducedModel& relative) const {
  const ReducedBasis& of = relative.basis_;
  ReducedBasis out{Eigen::MatrixXd(of.vectors.rows(), of.vectors.cols()), {}, {}, of.root};
  Eigen::Index count = 0;
  for (std::size_t i = 0; i < of.support.size(); ++i) {
    int support = -1;
    if (of.support[i] >= 0) {
      const std::string& label = relative.model_.parts()[static_cast<std::size_t>(of.support[i])].label;
      const auto part = std::find_if(model_.parts().begin(), model_.parts().end(),
                                     [&label](const Model::Part& p) { return p.label == label; });
      if (part == model_.parts().end()) continue;
      support = static_cast<int>(part - model_.parts().begin());
    }
    out.vectors.col(count++) = of.vectors.col(static_cast<Eigen::Index>(i));
    out.support.push_back(support);
    out.late.push_back(of.late[i]);
  }
  out.vectors.conservativeResize(Eigen::NoChange, count);
  return out;
}

void ReducedModel::adopt_projections(const ReducedModel& relative) {
  tbb::parallel_for(std::size_t{0}, projected_.size(), [&](std::size_t p) { adopt_projections(p, relative); });
}

void ReducedModel::adopt_projections(std::size_t index, const ReducedModel& relative) {
  const auto& part = model_.parts()[index];
  const auto& parts = relative.model_.parts();
  const auto there =
      std::find_if(parts.begin(), parts.end(), [&part](const Model::Part& p) { return p.label == part.label; });
  if (there == parts.end()) return;
  const Projected& known = relative.projected_[static_cast<std::size_t>(there - parts.begin())];
  Projected& out = projected_[index];
  const auto adopt = [](const auto& terms, const auto& others, const auto& from, auto& to) {
    for (std::size_t k = 0; k < std::min(terms.size(), others.size()); ++k) {
      if (same_matrix(*terms[k].matrix, *others[k].matrix)) to[k] = from[k];
    }
  };
  adopt(part.terms.mass, there->terms.mass, known.mass, out.mass);
  adopt(part.terms.stiffness, there->terms.stiffness, known.stiffness, out.stiffness);
  const std::vector<StrainTerm>&strained = part.terms.strain_stiffness, &others = there->terms.strain_stiffness;
  for (std::size_t k = 0; k < std::min(strained.size(), others.size()); ++k) {
    if (model_.estimated(part, strained[k].shape) || known.strain_stiffness[k].size() == 0) continue;
    const StrainFactorField here = strained[k].at(prior_parameters(model_, part));
    if (same_matrix(model_.fem(), here, others[k].at(prior_parameters(relative.model_, *there)))) {
      out.strain_stiffness[k] = known.strain_stiffness[k];
    }
  }
}

void ReducedModel::project() {
  bool strained = false, varies = false;
  for (std::size_t p = 0; p < projected_.size(); ++p) {
    const auto& part = model_.parts()[p];
    for (std::size_t k = 0; k < part.terms.strain_stiffness.size(); ++k) {
      strained = strained || projected_[p].strain_stiffness[k].size() == 0;
      varies = varies || model_.estimated(part, part.terms.strain_stiffness[k].shape);
    }
  }
  if (strained) strains_ = strains(model_.fem(), basis_.vectors);
  tbb::parallel_for(std::size_t{0}, projected_.size(), [this](std::size_t p) { project_part(p); });
  if (!varies) strains_.resize(0, 0);
}

// Projects everything that is not known yet.
void ReducedModel::project_part(std::size_t index) {
  const auto& part = model_.parts()[index];
  const Eigen::MatrixXd& b = basis_.vectors;
  Projected& out = projected_[index];
  for (std::size_t k = 0; k < part.terms.mass.size(); ++k) {
    const SparseMatrix& mass = *part.terms.mass[k].matrix;
    const Eigen::MatrixX3d unit = unit_motion(b.rows());
    Eigen::MatrixX3d loose = unit;
    for (Eigen::Index i = 0; i < loose.rows(); ++i) {
      if (model_.fixed()[static_cast<std::size_t>(i)] != 0) loose.row(i).setZero();
    }
    if (out.mass[k].size() == 0) out.mass[k] = project_matrix(mass, b);
    out.weight.push_back(b.transpose() * (mass * unit));
    out.momentum.push_back(b.transpose() * (mass * loose));
  }
  for (std::size_t k = 0; k < part.terms.stiffness.size(); ++k) {
    if (out.stiffness[k].size() == 0) out.stiffness[k] = project_matrix(*part.terms.stiffness[k].matrix, b);
  }
  for (std::size_t k = 0; k < part.terms.strain_stiffness.size(); ++k) {
    const StrainTerm& term = part.terms.strain_stiffness[k];
    if (out.strain_stiffness[k].size() > 0 || model_.estimated(part, term.shape)) continue;
    out.strain_stiffness[k] = project_strain_stiffness(model_.fem(), term.at(prior_parameters(model_, part)), strains_);
  }
  for (const auto& term : part.terms.loads) out.loads.push_back(b.transpose() * term.pattern);
}

void ReducedModel::project_reactions() {
  const std::vector<Model::Reaction>& reactions = model_.reactions();
  reaction_springs_.resize(basis_.vectors.cols(), 3 * static_cast<Eigen::Index>(reactions.size()));
  for (std::size_t r = 0; r < reactions.size(); ++r)
    reaction_springs_.middleCols<3>(3 * static_cast<Eigen::Index>(r)) = basis_.vectors.transpose() * reactions[r].springs;
}

}  // namespace tissue_stiffness
