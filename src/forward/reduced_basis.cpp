#include "forward/reduced_basis.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "forward/basis_seed_vectors.hpp"
#include "forward/orthonormal_basis.hpp"
#include "forward/static_response.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kManyLoads = 8;  // more of them have kPerLoad vectors each
constexpr Eigen::Index kPerLoad = 6;
constexpr int kLeading = 4;             // modes that tell what an absent effect would do
constexpr double kResponseShare = 0.6;  // of the room for absent effects: static responses; dynamic ones fill the rest
constexpr int kFew = 3;                 // absent effects that may grow large: their stiffness acts on what is added, too
constexpr double kFaint = 1e-12;        // of the strongest response, squared: what is left out
constexpr double kFree = 1e-9;          // of the highest eigenvalue: below it a body moves freely
constexpr double kRounding = 1e-14;     // of a coefficient

// Computes (P^T K P)^-1 on the coarser mesh.
struct CoarseResponse {
  const TwoGrid& grids;
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& loads) const { return grids.solve_coarse(loads); }
  Eigen::MatrixXd roughly(const Eigen::MatrixXd& loads) const { return grids.solve_coarse(loads); }
};

bool equal(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() && a == b;
}

// Terms whose sums are a body's mass and stiffness.
struct BodyTerms {
  using List = std::vector<std::pair<std::shared_ptr<const SparseMatrix>, double>>;
  List mass, stiffness;
  bool complete = true;  // nothing else is in them

  BodyTerms() = default;
  BodyTerms(const Model& model, const Eigen::VectorXd& theta) {
    const double factor = model.mass_factor(theta);
    for (const Model::Part& part : model.parts()) {
      const Eigen::VectorXd p = part.parameters(theta);
      for (const MatrixTerm& term : part.terms.mass) add(mass, term.matrix, factor * term.coefficient(p));
      for (const MatrixTerm& term : part.terms.stiffness) add(stiffness, term.matrix, term.coefficient(p));
      for (const StrainTerm& term : part.terms.strain_stiffness) complete = complete && term.coefficient(p) == 0.0;
    }
  }

  // Returns whether the mass is equal and the stiffness proportional. The responses then differ by a factor, which does not
  // matter in a basis.
  bool same_body(const BodyTerms& other) const {
    if (!complete || !other.complete || stiffness.empty() || other.stiffness.empty()) return false;
    const double ratio = other.stiffness.front().second / stiffness.front().second;
    return in_proportion(mass, other.mass, 1.0) && in_proportion(stiffness, other.stiffness, ratio);
  }

 private:
  static void add(List& list, const std::shared_ptr<const SparseMatrix>& matrix, double coefficient) {
    if (coefficient != 0.0) list.emplace_back(matrix, coefficient);
  }
  // Returns whether the coefficients have the ratio 1 to `ratio`.
  static bool in_proportion(const List& a, const List& b, double ratio) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [ratio](const auto& one, const auto& another) {
      return same_matrix(*one.first, *another.first) &&
             std::abs(ratio * one.second - another.second) <= kRounding * std::abs(another.second);
    });
  }
};

}  // namespace

class BasisRoot {
 public:
  // These members describe the body.
  BodyTerms terms;
  std::shared_ptr<const SparseMatrix> stiffness, mass;
  std::vector<char> fixed;
  std::shared_ptr<const StaticResponse> held;
  // These members describe what moves it.
  Eigen::MatrixXd loads;
  std::vector<SparseMatrix> groups;
  Eigen::Index size = 0;
  Eigen::MatrixXd vectors, weighted;  ///< the second: M times the first

  void take_body(const BasisRoot& known) {
    stiffness = known.stiffness;
    mass = known.mass;
    held = known.held;
  }

  bool same_motion(const BasisRoot& other) const {
    return size == other.size && equal(loads, other.loads) &&
           std::equal(groups.begin(), groups.end(), other.groups.begin(), other.groups.end(),
                      [](const SparseMatrix& a, const SparseMatrix& b) { return same_matrix(a, b); });
  }
};

namespace {

class Builder {
 public:
  Builder(const Model& model, const BasisOptions& options, const std::shared_ptr<const BasisRoot>& known)
      : model_(model), options_(options.grown()), prior_(model, options.around, options.reach), root_(make_root(known)) {}

  ReducedBasis build() {
    OrthonormalBasis basis(mass_, most(root_->loads.cols()));
    basis.begin(root_->vectors, root_->weighted);
    const Eigen::Index awake = basis.size();
    add_inactive(basis, root_->loads);
    if (basis.size() == 0) {
      throw InputError(model_.settings().name + ": effects", "nothing that moves the body",
                       "gravity, pressure, traction or an initial velocity");
    }
    ReducedBasis result{basis.vectors(), std::vector<int>(static_cast<std::size_t>(basis.size()), -1), {}, root_};
    mark(result, awake);
    mark(result, basis.size() - awake);
    add_supports(basis, root_->loads, result);
    return result;
  }

 private:
  // Many loads need more vectors: a prescribed motion has twelve.
  Eigen::Index beyond_size(Eigen::Index loads) const {
    return loads > kManyLoads ? std::max<Eigen::Index>(0, kPerLoad * loads - options_.size) : 0;
  }
  Eigen::Index most(Eigen::Index loads) const {
    const Eigen::Index free_dofs = model_.fem().dof_count() / 2;
    return std::min<Eigen::Index>(std::max(options_.size, options_.largest) + beyond_size(loads), free_dofs);
  }

  std::shared_ptr<const BasisRoot> make_root(const std::shared_ptr<const BasisRoot>& known) const {
    auto root = std::make_shared<BasisRoot>();
    root->terms = BodyTerms(model_, prior_.theta);
    root->fixed = model_.fixed(prior_.theta);
    const bool same_hold = known && known->fixed == root->fixed;
    bool same_body = same_hold && known->terms.same_body(root->terms);
    if (!same_body) {
      root->stiffness = share_matrix(model_.rest_stiffness(prior_.theta));
      SparseMatrix mass = model_.mass(prior_.theta);
      mass.prune(0.0);  // of each pair of nodes' 3 x 3 block, a third
      root->mass = share_matrix(std::move(mass));
      same_body = same_hold && same_matrix(*known->stiffness, *root->stiffness) && same_matrix(*known->mass, *root->mass);
    }
    if (same_body) root->take_body(*known);
    root->loads = acting_loads(model_, prior_, *root->mass);
    root->groups = stiffness_groups(model_, prior_);
    root->size = std::min(options_.size + beyond_size(root->loads.cols()), most(root->loads.cols()));
    if (same_body && known->same_motion(*root)) return known;
    if (!root->held) {
      root->held = std::make_shared<StaticResponse>(*root->stiffness, *root->mass, root->fixed, options_.coarser.get());
    }
    OrthonormalBasis basis(*root->mass, root->size);
    const bool between = root->held->grids() != nullptr && root->groups.empty();
    if (root->loads.cols() > 0) {
      between ? refine(basis, *root) : extend(basis, *root->held, root->loads, root->groups, root->size);
    }
    root->vectors = basis.vectors();
    root->weighted = basis.weighted();
    return root;
  }

  static void mark(ReducedBasis& basis, Eigen::Index count) {
    const auto early = static_cast<std::size_t>((count + 1) / 2);
    basis.late.insert(basis.late.end(), early, 0);
    basis.late.insert(basis.late.end(), static_cast<std::size_t>(count) - early, 1);
  }

  // Adds static responses to the loads, and then to the inertia (with several moduli also to the stiffnesses) of the last
  // added vectors.
  template <typename Response>
  static void extend(OrthonormalBasis& basis, const Response& respond, const Eigen::MatrixXd& loads,
                     const std::vector<SparseMatrix>& groups, Eigen::Index size) {
    // No more at once than there is room for.
    const auto add = [&](Eigen::Index columns, const auto& responses) {
      for (Eigen::Index at = 0; at < columns && basis.size() < size;) {
        const Eigen::Index count = std::min(columns - at, size - basis.size());
        basis.add(responses(at, count), size);
        at += count;
      }
    };
    Eigen::Index before = basis.size();
    add(loads.cols(), [&](auto at, auto count) { return respond(loads.middleCols(at, count)); });
    while (basis.size() > before && basis.size() < size) {
      const Eigen::MatrixXd block = basis.vectors().rightCols(basis.size() - before);
      const Eigen::MatrixXd inertia = basis.weighted().rightCols(block.cols());
      before = basis.size();
      add(block.cols() * static_cast<Eigen::Index>(1 + groups.size()),
          [&](auto at, auto count) { return respond.roughly(forces(block, inertia, groups, at, count)); });
    }
  }

  // Returns some columns of [M block, K block...].
  static Eigen::MatrixXd forces(const Eigen::MatrixXd& block, const Eigen::MatrixXd& inertia,
                                const std::vector<SparseMatrix>& groups, Eigen::Index first, Eigen::Index count) {
    const Eigen::Index width = block.cols();
    Eigen::MatrixXd out(block.rows(), count);
    for (Eigen::Index done = 0; done < count;) {
      const Eigen::Index source = (first + done) / width, at = (first + done) % width;
      const Eigen::Index part = std::min(count - done, width - at);
      if (source == 0) {
        out.middleCols(done, part) = inertia.middleCols(at, part);
      } else {
        out.middleCols(done, part) =
            symmetric_product(groups[static_cast<std::size_t>(source - 1)], block.middleCols(at, part));
      }
      done += part;
    }
    return out;
  }

  // Builds the vectors from those of the coarser mesh. All static responses, to the loads and to the inertia of each
  // vector, are computed together.
  static void refine(OrthonormalBasis& basis, const BasisRoot& root) {
    const TwoGrid& grids = *root.held->grids();
    const SparseMatrix mass = grids.to_coarse(*root.mass);
    OrthonormalBasis coarse(mass, std::min(root.size, mass.rows()));
    const CoarseResponse respond{grids};
    extend(coarse, respond, grids.to_coarse(root.loads), {}, root.size);
    Eigen::MatrixXd loads(root.loads.rows(), root.size);
    const Eigen::Index first = std::min(root.loads.cols(), root.size), rest = std::min(root.size - first, coarse.size());
    loads.leftCols(first) = root.loads.leftCols(first);
    loads.middleCols(first, rest) = symmetric_product(*root.mass, grids.to_fine(coarse.vectors().leftCols(rest)));
    basis.add(root.held->roughly(loads.leftCols(first + rest)), root.size);
  }

  // Returns the modes of the basis that the loads excite most.
  Eigen::MatrixXd leading_motion(const OrthonormalBasis& basis, const Eigen::MatrixXd& loads) const {
    Eigen::MatrixXd b = basis.vectors();
    if (b.cols() == 0) return b;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inner_products(b, symmetric_product(stiffness_, b)));
    const Eigen::VectorXd& square = eigen.eigenvalues();
    Eigen::MatrixXd share = eigen.eigenvectors().transpose() * (b.transpose() * loads);
    for (Eigen::Index k = 0; k < share.rows(); ++k) {
      share.row(k) *= square[k] > kFree * square[square.size() - 1] ? 1.0 / square[k] : 0.0;
    }
    for (Eigen::Index l = 0; l < share.cols(); ++l) {
      if (const double norm = share.col(l).norm(); norm > 0.0) share.col(l) /= norm;
    }
    const Eigen::VectorXd weight = share.rowwise().squaredNorm();
    std::vector<Eigen::Index> order(static_cast<std::size_t>(weight.size()));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    std::stable_sort(order.begin(), order.end(), [&](auto a, auto c) { return weight[a] > weight[c]; });
    const Eigen::Index count = std::min<Eigen::Index>(kLeading, b.cols());
    Eigen::MatrixXd modes(b.rows(), count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const Eigen::Index k = order[static_cast<std::size_t>(i)];
      modes.col(i) = std::sqrt(weight[k]) * (b * eigen.eigenvectors().col(k));
    }
    return modes;
  }

  // Adds static responses to the terms that are absent at the prior, each part's scaled to one, less their projection onto
  // the basis.
  void add_inactive(OrthonormalBasis& basis, const Eigen::MatrixXd& acting) const {
    bool answered = false;
    for (std::size_t p = 0; p < model_.parts().size(); ++p) answered = answered || answers_motion(model_, prior_, p);
    const Eigen::MatrixXd motion = answered ? leading_motion(basis, acting) : Eigen::MatrixXd(mass_.rows(), 0);
    const StrainRows rows = strains(model_.fem(), motion);
    const bool first_order = options_.nonlinear == BasisOptions::Nonlinear::first_order;
    std::vector<Eigen::MatrixXd> blocks;
    int parts = 0;
    for (std::size_t p = 0; p < model_.parts().size(); ++p) {
      if (!model_.parts()[p].compliant_nodes().empty()) continue;
      const std::size_t before = blocks.size();
      for (Eigen::MatrixXd block :
           {inactive_loads(model_, prior_, mass_, p), inactive_forces(model_, prior_, p, motion, rows),
            first_order ? extra_forces(model_, prior_, p, motion, rows) : Eigen::MatrixXd()}) {
        if (block.cols() > 0) blocks.push_back(std::move(block));
      }
      if (blocks.size() > before) ++parts;
    }
    if (parts == 0) return;
    const Eigen::Index room = std::min<Eigen::Index>(std::max(options_.largest - options_.size, 0),
                                                     static_cast<Eigen::Index>(options_.per_part) * parts);
    std::vector<SparseMatrix> groups;
    if (parts <= kFew) groups = inactive_stiffness(model_, prior_);
    add_common(basis, scaled_responses(blocks), groups, basis.size() + room);
  }

  // Returns K^-1 times all blocks, with each block's responses scaled to one.
  Eigen::MatrixXd scaled_responses(const std::vector<Eigen::MatrixXd>& blocks) const {
    Eigen::Index columns = 0;
    for (const Eigen::MatrixXd& block : blocks) columns += block.cols();
    Eigen::MatrixXd x(mass_.rows(), columns);
    Eigen::Index at = 0;
    for (const Eigen::MatrixXd& block : blocks) {
      x.middleCols(at, block.cols()) = block;
      at += block.cols();
    }
    x = root_->held->roughly(std::move(x));
    const Eigen::RowVectorXd squares = (x.array() * symmetric_product(mass_, x).array()).colwise().sum();
    at = 0;
    for (const Eigen::MatrixXd& block : blocks) {
      const double square = squares.segment(at, block.cols()).sum();
      if (square > 0.0) x.middleCols(at, block.cols()) /= std::sqrt(square);
      at += block.cols();
    }
    return x;
  }

  void add_common(OrthonormalBasis& basis, const Eigen::MatrixXd& responses, const std::vector<SparseMatrix>& groups,
                  Eigen::Index size) const {
    const Eigen::MatrixXd rest = basis.beside(responses);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inner_products(rest, symmetric_product(mass_, rest)));
    const Eigen::VectorXd& square = eigen.eigenvalues();
    const auto statics =
        basis.size() + static_cast<Eigen::Index>(kResponseShare * static_cast<double>(size - basis.size()));
    const Eigen::Index before = basis.size();
    const auto strong =
        std::min<Eigen::Index>((square.array() > kFaint * square[square.size() - 1]).count(), statics - before);
    basis.add(rest * eigen.eigenvectors().rightCols(strong).rowwise().reverse(), statics);
    const Eigen::MatrixXd added = basis.vectors().rightCols(basis.size() - before);
    if (added.cols() == 0) return;
    Eigen::MatrixXd loads = basis.weighted().rightCols(added.cols());
    for (const SparseMatrix& k : groups) {
      loads.conservativeResize(Eigen::NoChange, loads.cols() + added.cols());
      loads.rightCols(added.cols()) = symmetric_product(k, added);
    }
    extend(basis, *root_->held, loads, groups, size);
  }

  static SparseMatrix springs(const Model::Part& part, const Eigen::VectorXd& p) {
    SparseMatrix sum = *part.terms.stiffness.front().matrix;
    sum *= part.terms.stiffness.front().coefficient(p);
    return sum;
  }

  // Adds responses with the nodes on springs for each support that may be compliant. Responses to the springs cover other
  // compliances.
  void add_supports(const OrthonormalBasis& held, const Eigen::MatrixXd& acting, ReducedBasis& result) const {
    const Eigen::VectorXd prior = model_.parameters().theta(prior_.place);
    for (std::size_t p = 0; p < model_.parts().size(); ++p) {
      const auto& part = model_.parts()[p];
      if (part.compliant_nodes().empty() || !model_.estimated(part, {0})) continue;
      Eigen::VectorXd theta = prior_.theta;
      const Eigen::VectorXd& soft = part.is_compliant(part.parameters(prior)) ? prior : prior_.generic;
      for (const int index : part.indices) theta[index] = soft[index];
      const StaticResponse respond(model_.rest_stiffness(theta), mass_, model_.fixed(theta), nullptr);
      const Eigen::Index before = held.size();
      OrthonormalBasis basis(mass_, before + options_.released);
      basis.add(held.vectors(), before);
      extend(basis, respond, acting, {springs(part, part.parameters(theta))}, basis.size() + options_.released);
      const Eigen::Index count = basis.size() - before;
      result.vectors.conservativeResize(Eigen::NoChange, result.vectors.cols() + count);
      result.vectors.rightCols(count) = basis.vectors().rightCols(count);
      result.support.insert(result.support.end(), static_cast<std::size_t>(count), static_cast<int>(p));
      mark(result, count);
    }
  }

  const Model& model_;
  BasisOptions options_;
  PriorView prior_;
  std::shared_ptr<const BasisRoot> root_;
  const SparseMatrix &mass_ = *root_->mass, &stiffness_ = *root_->stiffness;
};

}  // namespace

BasisOptions BasisOptions::grown() const {
  BasisOptions out = *this;
  for (; out.growths > 0; --out.growths) {
    for (int* count : {&out.size, &out.per_part, &out.largest, &out.released}) *count += (*count + 1) / 2;
  }
  return out;
}

ReducedBasis build_reduced_basis(const Model& model, const BasisOptions& options,
                                 const std::shared_ptr<const BasisRoot>& known) {
  return Builder(model, options, known).build();
}

}  // namespace tissue_stiffness
