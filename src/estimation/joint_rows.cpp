#include "estimation/joint_rows.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "observation/neighbour_differences.hpp"

namespace tissue_stiffness {
namespace {

constexpr Eigen::Index kModes = 12;  // modes along which missing physics is searched

bool same_mesh(const TetMesh& a, const TetMesh& b) {
  return a.nodes.cols() == b.nodes.cols() && a.tets.cols() == b.tets.cols() && a.nodes == b.nodes && a.tets == b.tets;
}

SharedColumns shared_columns(const Sharing& sharing, const SharedParameters& parameters, const JointRows::Parts& parts) {
  std::vector<SharedColumns::OfRecording> recordings;
  for (const auto& part : parts) {
    int mesh = 0;
    while (!same_mesh(parts[static_cast<std::size_t>(mesh)]->models.base.mesh(), part->models.base.mesh())) ++mesh;
    recordings.push_back(
        {part->rows.groups(), part->rows.size() - part->rows.first_of_mesh(), part->models.constants, mesh});
  }
  return {sharing, parameters, recordings};
}

// Returns the differences between neighbouring points, of unit variance for noise as stated. Force sensors have none.
Eigen::VectorXd differences(NeighbourWeights& weights, const InputLinearisation::Row& row,
                            const Eigen::VectorXd& residual) {
  Eigen::VectorXd used = row.precision;
  for (const Eigen::Index force : row.forces) used[force] = 0.0;
  const Eigen::VectorXd root = used.cwiseSqrt();
  return neighbour_differences(weights.of(row.nodes, row.places, used), root.cwiseInverse()) * root.cwiseProduct(residual);
}

void set(Eigen::VectorXd& all, const std::vector<Eigen::Index>& columns, const Eigen::VectorXd& own) {
  for (std::size_t i = 0; i < columns.size(); ++i) all[columns[i]] = own[static_cast<Eigen::Index>(i)];
}

}  // namespace

JointRows::JointRows(Parts parts, const Sharing& sharing, const SharedParameters& parameters)
    : parts_(std::move(parts)), parameters_(parameters), columns_(shared_columns(sharing, parameters, parts_)) {}

Eigen::VectorXd JointRows::asked() const {
  Eigen::VectorXd out(parameters_.size());
  for (std::size_t r = parts_.size(); r > 0; --r) set(out, parameters_.columns(r - 1), parts_[r - 1]->question.w);
  return out;
}

Eigen::VectorXd JointRows::prior_std() const {
  Eigen::VectorXd out(parameters_.size());
  for (std::size_t r = 0; r < parts_.size(); ++r) set(out, parameters_.columns(r), parts_[r]->question.prior_std);
  return out;
}

Eigen::VectorXd JointRows::nuisance_std() const {
  Eigen::VectorXd out = Eigen::VectorXd::Constant(columns_.size() - parameters_.size(), std::sqrt(kTails));
  out.tail(columns_.size() - columns_.first_of_mesh()).setOnes();
  return out;
}

NormalEquations JointRows::of(std::size_t recording, const Eigen::VectorXd& z, Constants constants) const {
  return columns_.spread(recording, parts_[recording]->rows.at(columns_.of(recording, z), constants));
}

InputPosterior::Equations JointRows::at(const Eigen::VectorXd& z, Constants constants) const {
  InputPosterior::Equations out;
  for (std::size_t r = 0; r < parts_.size(); ++r) {
    out.push_back(parts_[r]->predicted
                      ? NormalEquations(columns_.size(), static_cast<Eigen::Index>(columns_.constants().size()))
                      : of(r, z, constants));
  }
  return out;
}

MisfitTest JointRows::test(std::size_t recording, const Eigen::VectorXd& z, double fitted,
                           const InputPosterior::Tolerated& tolerated) const {
  const Eigen::VectorXd move = columns_.of(recording, tolerated.z),
                        constants = columns_.constants_of(recording, tolerated.constants);
  MisfitTest out;
  NeighbourWeights weights;
  parts_[recording]->rows.each_row(
      columns_.of(recording, z), Constants::varied,
      [&](const InputLinearisation::Row& row, const Eigen::MatrixXd& amplitudes) {
        const Eigen::Index p = row.parameters.cols(), d = row.direct.cols(), l = amplitudes.cols();
        const Eigen::VectorXd explained = row.constants * constants + row.parameters * move.head(p) +
                                          row.modes * (amplitudes * move.segment(p, l)) + row.direct * move.tail(d);
        const Eigen::Index most = std::min<Eigen::Index>(kModes, std::max<Eigen::Index>(1, row.error.size() / 4));
        const Eigen::VectorXd residual = row.error - explained;
        out.add(residual, row.precision,
                with_unit_columns(row.modes.leftCols(std::min(most, row.modes.cols())), row.forces));
        out.add_differences(differences(weights, row, residual));
      });
  out.set_fitted(fitted);
  return out;
}

double JointRows::temperature(std::size_t recording, const MisfitTest& test) const {
  const double hidden = std::max(0.0, test.excess()) + test.deviation();
  return 1.0 + hidden * test.structured_dof() * parts_[recording]->rows.repeated();
}

}  // namespace tissue_stiffness
