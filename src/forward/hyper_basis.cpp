#include "forward/hyper_basis.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "fem/nonnegative_least_squares.hpp"
#include "fem/products.hpp"
#include "forward/orthogonal_decomposition.hpp"
#include "forward/orthonormal_basis.hpp"
#include "forward/project_matrix.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kRigid = 1e-8;   // of the highest omega^2: below it a vector has no strain
constexpr double kVolume = 0.03;  // weight of the body's volume beside the forces
constexpr double kAtRest = 0.1;   // weight of the forces of each vector at rest
constexpr int kMostVectors = 28, kMostPoints = 400;
constexpr double kLeastEnergy = 1e-10, kLeastForce = 3e-5;  // shares left
constexpr double kStill = 1e-3;                             // of the largest force: states with less hardly count

// Reorders the numbers from 0 to count - 1 as if at random, alike on every machine (splitmix64: Steele, Lea & Flood 2014).
std::vector<int> shuffled(int count) {
  const auto mixed = [](std::uint64_t x) {
    x = (x + 1) * 0x9e3779b97f4a7c15U;
    x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
    x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
    return x ^ (x >> 31U);
  };
  std::vector<int> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return mixed(static_cast<std::uint64_t>(a)) < mixed(static_cast<std::uint64_t>(b)); });
  return order;
}

// Vectors of the snapshots, the most energetic first.
Eigen::MatrixXd decompose(const Eigen::MatrixXd& snapshots, const SparseMatrix& stiffness, const SparseMatrix& mass,
                          const HyperOptions& options) {
  const Eigen::MatrixXd elastic = inner_products(snapshots, symmetric_product(stiffness, snapshots)),
                        inertial = inner_products(snapshots, symmetric_product(mass, snapshots));
  const double share = inertial.trace() > 0.0 ? elastic.trace() / inertial.trace() : 0.0;
  return most_energetic(snapshots, elastic + share * inertial, options.energy_left, options.largest);
}

class Chooser {
 public:
  Chooser(const Model& model, const FullMotions& motions, const HyperOptions& options)
      : model_(model), options_(options), states_(motions.thinned(options.states)) {
    const Eigen::VectorXd& theta = motions.thetas.front();
    SparseMatrix mass = model.mass(theta);
    mass.prune(0.0);
    const SparseMatrix stiffness = model.rest_stiffness(theta);
    OrthonormalBasis basis(mass, options.largest);
    basis.add(decompose(motions.displacements, stiffness, mass, options), options.largest);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(project_matrix(stiffness, basis.vectors()));
    out_.vectors = basis.vectors() * modes.eigenvectors();
    out_.square = modes.eigenvalues();
    compliance_ = root_compliance();
    coordinates_ = inner_products(symmetric_product(mass, out_.vectors), states_.displacements);
  }

  HyperBasis choose() {
    const Discretisation& fem = model_.fem();
    const int per_element = fem.points_per_element();
    std::vector<int> order = shuffled(fem.element_count() * per_element);
    order.resize(std::min(order.size(), static_cast<std::size_t>(options_.candidates)));
    std::sort(order.begin(), order.end());
    std::vector<SampledPoint> candidates;
    for (const int k : order) {
      const int e = k / per_element, q = k % per_element;
      candidates.push_back({e, q, fem.weight(e, q)});
    }
    const Eigen::MatrixXd gradients = point_gradients(candidates);
    Eigen::VectorXd wanted;
    const Eigen::MatrixXd shares = equations(candidates, gradients, wanted);
    const SparseWeights chosen = nonnegative_least_squares(shares, wanted, options_.force_left, options_.most_points);
    out_.force_left = chosen.left;
    for (Eigen::Index k = 0; k < coordinates_.cols(); ++k) {
      out_.trained = std::max(out_.trained, out_.energy(coordinates_.col(k)));
    }
    out_.gradients.resize(9 * static_cast<Eigen::Index>(chosen.columns.size()), out_.vectors.cols());
    for (std::size_t i = 0; i < chosen.columns.size(); ++i) {
      SampledPoint point = candidates[static_cast<std::size_t>(chosen.columns[i])];
      point.weight *= chosen.weights[static_cast<Eigen::Index>(i)];
      out_.points.push_back(point);
      out_.gradients.middleRows<9>(9 * static_cast<Eigen::Index>(i)) = gradients.middleRows<9>(9 * chosen.columns[i]);
    }
    return std::move(out_);
  }

 private:
  using PointRows = Eigen::Ref<const Eigen::Matrix<double, 9, Eigen::Dynamic>, 0, Eigen::OuterStride<>>;
  struct Law {
    const FiniteStrainForm* form;
    std::size_t part;
  };

  // Returns 1 / omega; motions without strain count as the softest with strain.
  Eigen::VectorXd root_compliance() const {
    const double most = out_.square[out_.square.size() - 1];
    const double softest = (out_.square.array() > kRigid * most).select(out_.square, most).minCoeff();
    return out_.square.cwiseMax(softest).cwiseSqrt().cwiseInverse();
  }

  Eigen::MatrixXd point_gradients(const std::vector<SampledPoint>& points) const {
    const Discretisation& fem = model_.fem();
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(9 * static_cast<Eigen::Index>(points.size()), out_.vectors.cols());
    tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t k) {
      const auto g = fem.gradient(points[k].element, points[k].point);
      auto rows = out.middleRows<9>(9 * static_cast<Eigen::Index>(k));
      for (int a = 0; a < fem.nodes_per_element(); ++a) {
        const auto node = out_.vectors.middleRows<3>(3 * fem.elements()(a, points[k].element));
        for (int j = 0; j < 3; ++j) rows.middleRows<3>(3 * j) += g(j, a) * node;
      }
    });
    return out;
  }

  std::vector<Law> laws() const {
    std::vector<Law> out;
    for (std::size_t i = 0; i < model_.parts().size(); ++i) {
      const FiniteStrainForm* form = model_.parts()[i].effect->finite_strain();
      if (form != nullptr && form->point_form() != nullptr) out.push_back({form, i});
    }
    return out;
  }

  // The equations of a law: m for each state, and one for each pair of vectors at rest.
  Eigen::Index pairs() const { return out_.vectors.cols() * (out_.vectors.cols() + 1) / 2; }
  Eigen::Index rows_of_a_law() const { return coordinates_.size() + pairs(); }

  // Returns the equations' matrix, a column for each candidate, and what they should sum to.
  Eigen::MatrixXd equations(const std::vector<SampledPoint>& candidates, const Eigen::MatrixXd& gradients,
                            Eigen::VectorXd& wanted) const {
    const std::vector<Law> laws = this->laws();
    const Eigen::Index rows = rows_of_a_law();
    Eigen::MatrixXd shares(static_cast<Eigen::Index>(laws.size()) * rows + 1, static_cast<Eigen::Index>(candidates.size()));
    wanted.resize(shares.rows());
    const Eigen::VectorXd norms = state_forces(laws, wanted);
    for (std::size_t l = 0; l < laws.size(); ++l) {
      const Eigen::Index first = static_cast<Eigen::Index>(l) * rows;
      wanted.segment(first + coordinates_.size(), pairs()) = lower(scaled(rest_stiffness(laws[l])));
      tbb::parallel_for(Eigen::Index{0}, shares.cols(), [&](Eigen::Index k) {
        add_shares(laws[l], candidates[static_cast<std::size_t>(k)], gradients.middleRows<9>(9 * k), norms,
                   shares.col(k).segment(first, rows));
      });
    }
    const double size = kVolume * wanted.head(wanted.size() - 1).norm() / model_.fem().volume();
    wanted[wanted.size() - 1] = size * model_.fem().volume();
    for (Eigen::Index k = 0; k < shares.cols(); ++k) {
      shares(shares.rows() - 1, k) = size * candidates[static_cast<std::size_t>(k)].weight;
    }
    return shares;
  }

  // Computes a candidate's shares of a law's forces.
  void add_shares(const Law& law, const SampledPoint& point, const PointRows& g, const Eigen::VectorXd& norms,
                  Eigen::Ref<Eigen::VectorXd> out) const {
    const Eigen::Index m = out_.vectors.cols();
    const Eigen::Matrix<double, 9, Eigen::Dynamic> compliant = g * compliance_.asDiagonal();
    const PointForm& form = *law.form->point_form();
    for (Eigen::Index s = 0; s < coordinates_.cols(); ++s) {
      Eigen::Matrix3d f = Eigen::Matrix3d::Identity(), p = Eigen::Matrix3d::Zero();
      Eigen::Map<Eigen::Matrix<double, 9, 1>>(f.data()) += g * coordinates_.col(s);
      form.add_stress(point.element, point.point, f, parameters(law, s), p);
      out.segment(s * m, m) =
          point.weight / norms[s] * (compliant.transpose() * Eigen::Map<const Eigen::Matrix<double, 9, 1>>(p.data()));
    }
    StressTangent at_rest = StressTangent::Zero();
    form.add_tangent(point.element, point.point, Eigen::Matrix3d::Identity(), parameters(law, 0), at_rest);
    out.tail(pairs()) = lower(kAtRest * point.weight * compliant.transpose() * (at_rest * compliant));
  }

  static Eigen::VectorXd lower(const Eigen::MatrixXd& symmetric) {
    Eigen::VectorXd out(symmetric.rows() * (symmetric.rows() + 1) / 2);
    for (Eigen::Index j = 0, at = 0; j < symmetric.cols(); ++j) {
      const Eigen::Index count = symmetric.rows() - j;
      out.segment(at, count) = symmetric.col(j).tail(count);
      at += count;
    }
    return out;
  }

  Eigen::VectorXd parameters(const Law& law, Eigen::Index state) const {
    return model_.parts()[law.part].parameters(states_.thetas[static_cast<std::size_t>(state)]);
  }

  // Computes what all points give in each state, over omega. Returns the energy norm of the sum over the laws.
  Eigen::VectorXd state_forces(const std::vector<Law>& laws, Eigen::VectorXd& wanted) const {
    const Eigen::Index m = out_.vectors.cols(), states = coordinates_.cols();
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(m, states);
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(out_.vectors.rows());
    const auto own = [&](std::size_t l) {
      return Eigen::Map<Eigen::MatrixXd>(wanted.data() + static_cast<Eigen::Index>(l) * rows_of_a_law(), m, states);
    };
    for (Eigen::Index s = 0; s < states; ++s) {
      const Eigen::VectorXd u = out_.vectors * coordinates_.col(s);
      for (std::size_t l = 0; l < laws.size(); ++l) {
        Eigen::VectorXd force = Eigen::VectorXd::Zero(u.size());
        laws[l].form->add_finite_force({0.0, u, still, 1.0}, parameters(laws[l], s), force);
        own(l).col(s) = -compliance_.cwiseProduct(out_.vectors.transpose() * force);
        sum.col(s) += own(l).col(s);
      }
    }
    const Eigen::VectorXd norms = sum.colwise().norm().transpose();
    const Eigen::VectorXd scale = norms.cwiseMax(kStill * norms.maxCoeff());
    for (std::size_t l = 0; l < laws.size(); ++l) own(l) *= scale.cwiseInverse().asDiagonal();
    return scale;
  }

  Eigen::MatrixXd rest_stiffness(const Law& law) const {
    const Eigen::VectorXd still = Eigen::VectorXd::Zero(out_.vectors.rows());
    SparseMatrix stiffness = model_.fem().pattern();
    law.form->add_finite_stiffness({0.0, still, still, 1.0}, parameters(law, 0), stiffness);
    return project_matrix(stiffness, out_.vectors);
  }
  Eigen::MatrixXd scaled(const Eigen::MatrixXd& stiffness) const {
    return kAtRest * compliance_.asDiagonal() * stiffness * compliance_.asDiagonal();
  }

  const Model& model_;
  const HyperOptions& options_;
  FullMotions states_;
  HyperBasis out_;
  Eigen::VectorXd compliance_;   ///< its root, 1 / omega [s/rad]
  Eigen::MatrixXd coordinates_;  ///< of the states
};

}  // namespace

void FullMotions::add(const FullMotions& other) {
  const Eigen::Index before = displacements.cols();
  displacements.conservativeResize(other.displacements.rows(), before + other.displacements.cols());
  displacements.rightCols(other.displacements.cols()) = other.displacements;
  thetas.insert(thetas.end(), other.thetas.begin(), other.thetas.end());
}

FullMotions FullMotions::thinned(Eigen::Index count) const {
  const Eigen::Index all = displacements.cols();
  if (all <= count) return *this;
  FullMotions out{Eigen::MatrixXd(displacements.rows(), count), {}};
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::Index from = (2 * k + 1) * all / (2 * count);
    out.displacements.col(k) = displacements.col(from);
    out.thetas.push_back(thetas[static_cast<std::size_t>(from)]);
  }
  return out;
}

HyperOptions HyperOptions::finer() const {
  HyperOptions out = *this;
  out.largest = std::min(kMostVectors, largest + 8);
  out.most_points = std::min(kMostPoints, most_points + 100);
  out.energy_left = std::max(kLeastEnergy, 0.1 * energy_left);
  out.force_left = std::max(kLeastForce, 0.3 * force_left);
  return out;
}

HyperBasis choose_hyper_basis(const Model& model, const FullMotions& motions, const HyperOptions& options) {
  return Chooser(model, motions, options).choose();
}

namespace {

// A law at points has forms for small strain, too. They count where the model is not finite throughout, and where damping
// acts through them.
bool has_more_than_points(const Model& model, const ModelPart& part) {
  const FiniteStrainForm* form = part.effect->finite_strain();
  const bool strain_terms = !part.terms.strain_stiffness.empty();
  if (form == nullptr || form->point_form() == nullptr) {
    const bool unknown = form != nullptr && form->follower_load() == nullptr;
    return unknown || strain_terms || part.effect->nonlinear_force() != nullptr;
  }
  if (!model.always_finite()) return strain_terms || part.effect->nonlinear_force() != nullptr;
  return strain_terms && !form->has_strain_form() && model.may_damp_by_stiffness();
}

}  // namespace

std::string why_not_hyper_reduced(const Model& model) {
  if (!model.may_be_finite()) return "no law of finite strain";
  if (model.starts_in_motion()) return "the body starts in motion";
  if (!model.reactions().empty()) return "reactions to a prescribed motion";
  for (const Model::Part& part : model.parts()) {
    if (has_more_than_points(model, part) || !part.terms.relaxation.empty() || !part.compliant_nodes().empty()) {
      return part.label + " has no form at sampled points";
    }
  }
  return "";
}

}  // namespace tissue_stiffness
