#include "diagnosis/model_comparison.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnosis/scores.hpp"
#include "forward/reduced_trajectory.hpp"
#include "observation/neighbour_differences.hpp"
#include "tissue_stiffness/types/prediction.hpp"
#include "types/least_squares.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kNarrower = 0.25;  // ratio of the widths of successive priors in the mixture
constexpr int kSizes = 32;          // of the mesh's error, over which a test is averaged
constexpr int kModalSizes = 4;      // the same for the modal evidence, with both ends
constexpr double kTiny = 1e-12;     // [sigma^2]: a direction that no row sees

double log_determinant(const Eigen::LDLT<Eigen::MatrixXd>& factor) {
  return factor.vectorD().array().max(std::numeric_limits<double>::min()).log().sum();
}

Eigen::MatrixXd lowest_modes(const FittedModel& fitted) {
  const RecordingFit& recording_fit = *fitted.recording_fit;
  const auto reduced = recording_fit.reduced();
  const double start = recording_fit.recording().first_stamp + recording_fit.model().settings().time.start;
  const ReducedTrajectory at_rest(*reduced, recording_fit.model().parameters().theta(fitted.fit.w), start);
  const Eigen::Index count = std::min<Eigen::Index>(kComparison.modes, at_rest.frequencies().size());
  return recording_fit.rows_along(fitted.fit.w, at_rest.mode_shapes(static_cast<int>(count)), fitted.rows);
}

std::vector<SparseMatrix> differences_of(const RecordingRows& rows) {
  std::vector<SparseMatrix> out;
  for (Eigen::Index k = 0; k < rows.frames.count(); ++k) {
    const auto [from, size] = rows.frames[k];
    Eigen::VectorXd used = rows.used.segment(from, size);
    used = (rows.nodes.segment(from, size).array() == kForceRow).select(0.0, used);
    out.push_back(neighbour_differences(rows.places.middleCols(from, size), rows.sigma.segment(from, size), used));
  }
  return out;
}

/// The change of every frame, divided into its shares along the lowest modes and the rest.
struct Parted {
  Eigen::MatrixXd columns;  ///< N x (modes + 1)
  Eigen::MatrixXd shares;   ///< frames x modes, in units of the mode's rows in that frame
};

Parted parted(const Eigen::VectorXd& change, const Eigen::MatrixXd& along, const FrameRows& frames) {
  const Eigen::Index modes = std::min<Eigen::Index>(kComparison.modes, along.cols());
  Parted out{Eigen::MatrixXd::Zero(change.size(), modes + 1), Eigen::MatrixXd::Zero(frames.count(), modes)};
  for (Eigen::Index k = 0; k < frames.count(); ++k) {
    const auto [from, size] = frames[k];
    if (size == 0) continue;
    const Eigen::MatrixXd lowest = along.block(from, 0, size, modes);
    const Eigen::VectorXd own = change.segment(from, size), share = least_squares(lowest, own);
    out.columns.block(from, 0, size, modes) = lowest * share.asDiagonal();
    out.columns.block(from, modes, size, 1) = own - lowest * share;
    out.shares.row(k) = share.transpose();
  }
  return out;
}

// Returns how many frames count as one, by the autocorrelation of a course (Bartlett 1946).
double repeated(const Eigen::VectorXd& course) {
  const double square = course.squaredNorm();
  double out = 1.0;
  if (!(square > 0.0)) return out;
  for (Eigen::Index lag = 1; lag < course.size(); ++lag) {
    const Eigen::Index size = course.size() - lag;
    const double correlation = course.head(size).dot(course.tail(size)) / square;
    out += 2.0 * correlation * correlation;
  }
  return out;
}

Eigen::MatrixXd whitened_by(const MeshAllowance& mesh, double s, const FrameRows& frames, const Eigen::MatrixXd& rows) {
  Eigen::MatrixXd out = rows;
  for (Eigen::Index k = 0; k < frames.count(); ++k) {
    const auto [from, size] = frames[k];
    if (size == 0 || mesh.variances.size() == 0) continue;
    const auto basis = mesh.basis.middleRows(from, size);
    const Eigen::ArrayXd shrink = 1.0 - (s / (s + mesh.variances.col(k).array())).sqrt();
    out.middleRows(from, size) -=
        basis * (shrink.matrix().asDiagonal() * (basis.transpose() * rows.middleRows(from, size)));
  }
  return out;
}

/// What the mesh's error may explain of a residual's sum of squares along the mesh's directions.
class AlongMesh {
 public:
  AlongMesh(const MeshAllowance& mesh, const FrameRows& frames, const Eigen::VectorXd& left)
      : squares_(Eigen::ArrayXXd::Zero(mesh.of_frame.rows(), mesh.of_frame.cols())),
        variances_(mesh.of_frame.array()),
        repeated_((variances_ > 0.0).select(mesh.variances.array() / variances_, 1.0)) {
    for (Eigen::Index k = 0; k < squares_.cols(); ++k) {
      const auto [from, size] = frames[k];
      squares_.col(k) = (mesh.basis.middleRows(from, size).transpose() * left.segment(from, size)).array().square();
    }
  }

  // Takes off what an error that is r times as large explains beside noise of the level v.
  void explain(double v, double r, MisfitTest& test) const {
    const Eigen::ArrayXXd share = r * r * variances_ / (v + r * r * variances_);
    test.set_explained((squares_ * share).sum(), 2.0 * v * v * (share.square() * repeated_).sum());
  }

 private:
  Eigen::ArrayXXd squares_, variances_, repeated_;  ///< directions x frames
};

// Returns the size of the mesh's error over what a refinement changes. It is evenly distributed by its logarithm.
double size_of_mesh_error(double quantile) {
  return kComparison.least_of_mesh * std::pow(kComparison.whole_mesh / kComparison.least_of_mesh, quantile);
}

Eigen::MatrixXd side_by_side(const Eigen::MatrixXd& left, const Eigen::MatrixXd& right) {
  Eigen::MatrixXd out(left.rows(), left.cols() + right.cols());
  out << left, right;
  return out;
}

// Returns the shapes of a frame's rows and the unit column of each row that is a force.
Eigen::MatrixXd with_forces(const Eigen::MatrixXd& shapes, const Eigen::VectorXi& nodes) {
  std::vector<Eigen::Index> forces;
  for (Eigen::Index i = 0; i < nodes.size(); ++i) {
    if (nodes[i] == kForceRow) forces.push_back(i);
  }
  return with_unit_columns(shapes, forces);
}

// Returns the widths of the amplitudes' priors over the stated width.
std::vector<double> scales_of(const Linearisation& model) {
  std::vector<double> out;
  double scale = 1.0;
  do {
    out.push_back(scale);
    scale *= kNarrower;
  } while (!model.amplitudes.empty() && scale >= kComparison.smallest);
  return out;
}

/// Laplace's approximation for rows of variance s: error ~ N(rows u, s I), without the rows' weights.
struct Laplace {
  Laplace(const Linearisation& model, const Eigen::MatrixXd& rows, const Eigen::VectorXd& error, double s) {
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(rows.cols());
    mean.head(model.prior.size()) = model.prior;
    const Eigen::MatrixXd gram = rows.transpose() * rows / s;
    const Eigen::VectorXd seen = rows.transpose() * error / s;
    const Eigen::Index own = model.parameters, rest = rows.cols() - own;
    std::vector<double> evidence;
    for (const double scale : scales_of(model)) {
      Eigen::VectorXd weight = Eigen::VectorXd::Ones(rows.cols());
      for (const Eigen::Index i : model.amplitudes) weight[i] = 1.0 / (scale * scale);
      Eigen::MatrixXd precision = gram;
      precision.diagonal() += weight;
      const Eigen::LDLT<Eigen::MatrixXd> factor(precision);
      const Eigen::VectorXd pull = seen + weight.cwiseProduct(mean);
      Eigen::VectorXd at = factor.solve(pull);
      // Numerics that are not plausible explain nothing, so the parameters have to do without them.
      at.tail(rest) = at.tail(rest).cwiseMax(-MisfitTest::bound).cwiseMin(MisfitTest::bound);
      at.head(own) = precision.topLeftCorner(own, own).ldlt().solve(pull.head(own) -
                                                                    precision.topRightCorner(own, rest) * at.tail(rest));
      const double likelihood = -0.5 * (error - rows * at).squaredNorm() / s;
      evidence.push_back(likelihood - 0.5 * (weight.dot((at - mean).cwiseAbs2()) + log_determinant(factor)) +
                         0.5 * weight.array().log().sum());
      if (evidence.back() < *std::max_element(evidence.begin(), evidence.end())) continue;
      most_probable = at;
      log_likelihood = likelihood;
    }
    log_evidence = log_mean_exp(evidence);
  }

  double log_evidence = 0.0, log_likelihood = 0.0;
  Eigen::VectorXd most_probable;
};

}  // namespace

ModelComparison::ModelComparison(const FittedModel& base, const Eigen::VectorXd& mesh_change)
    : used_((base.rows.used.array() > 0.0).cast<double>()),
      nodes_(base.rows.nodes),
      frames_(base.rows.frames),
      differences_(differences_of(base.rows)),
      along_(lowest_modes(base)),
      base_cost_(base.rows.error.squaredNorm()) {
  for (Eigen::Index k = 0; k < frames_.count(); ++k) {
    const auto [from, size] = frames_[k];
    const Eigen::MatrixXd shapes = with_forces(along_.middleRows(from, size), nodes_.segment(from, size));
    modal_.push_back(orthonormal(used_.segment(from, size).asDiagonal() * shapes));
    modal_frames_.append(modal_.back().cols());
  }
  allow_for_mesh(mesh_change);
  note(base.rows.error);
}

void ModelComparison::allow_for_mesh(const Eigen::VectorXd& change) {
  mesh_ = allowance(change);
  modal_mesh_ = {along_modes(mesh_.columns), along_modes(mesh_.basis), mesh_.variances, {}};
}

MeshAllowance ModelComparison::allowance(const Eigen::VectorXd& change) const {
  Parted parts = parted(kComparison.whole_mesh * change, along_, frames_);
  MeshAllowance out{std::move(parts.columns), {}, {}, {}};
  const Eigen::Index modes = out.columns.cols() - 1, frames = frames_.count();
  // The mesh's error has the mean square of that part of D, and D's memory. Amplitudes that are independent from frame to
  // frame say as much of it if they have its spectral density.
  constexpr double part = kComparison.least_of_mesh / kComparison.whole_mesh;
  const Eigen::VectorXd square = part * part * out.columns.leftCols(modes).colwise().squaredNorm().transpose();
  Eigen::VectorXd memory(modes);
  for (Eigen::Index i = 0; i < modes; ++i) memory[i] = repeated(parts.shares.col(i));
  const Eigen::VectorXd size = along_.leftCols(modes).colwise().squaredNorm().transpose();
  const Eigen::VectorXd std = square.cwiseProduct(memory).cwiseQuotient(size.cwiseMax(kTiny * kTiny)).cwiseSqrt();
  out.basis = Eigen::MatrixXd::Zero(along_.rows(), modes);
  out.variances = Eigen::MatrixXd::Zero(modes, frames);
  out.of_frame = Eigen::MatrixXd::Zero(modes, frames);
  for (Eigen::Index k = 0; k < frames; ++k) {
    const auto [from, rows] = frames_[k];
    const Eigen::MatrixXd root = along_.block(from, 0, rows, modes) * std.asDiagonal();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(root.transpose() * root);
    for (Eigen::Index i = 0; i < modes; ++i) {
      const double variance = eigen.eigenvalues()[i];
      if (!(variance > kTiny)) continue;
      out.basis.block(from, i, rows, 1) = root * eigen.eigenvectors().col(i) / std::sqrt(variance);
      out.variances(i, k) = variance;
      const Eigen::VectorXd own = root.transpose() * out.basis.block(from, i, rows, 1);
      out.of_frame(i, k) = own.cwiseQuotient(memory.cwiseSqrt()).squaredNorm();
    }
  }
  return out;
}

void ModelComparison::move_base(const Eigen::VectorXd& error, const Eigen::VectorXd& mesh_change) {
  base_cost_ = error.squaredNorm();
  allow_for_mesh(mesh_change);
  note(error);
}

Eigen::MatrixXd ModelComparison::whitened(const Eigen::MatrixXd& rows) const {
  return whitened_by(mesh_, noise_variance_, frames_, rows);
}

void ModelComparison::note(const Eigen::VectorXd& error) {
  MisfitTest left = test_of(error, 0.0);
  left.set_noise(MisfitTest::most_noise);
  const double memory = left.lag1_autocorrelation(), variance = left.noise_level() * (1.0 + memory) / (1.0 - memory);
  noise_variance_ = noise_variance_ > 0.0 ? std::min(noise_variance_, variance) : variance;
  noise_level_ = std::min(noise_level_, left.noise_level());
}

void ModelComparison::note(const ModelComparison& other) {
  noise_variance_ = std::min(noise_variance_, other.noise_variance_);
  noise_level_ = std::min(noise_level_, other.noise_level_);
}

Assessment ModelComparison::assess(const Explained& explained) const {
  Assessment out = assess(explained, mesh_);
  const Linearisation& model = explained.linearisation;
  const Eigen::MatrixXd rows = along_modes(side_by_side(explained.error, model.columns));
  out.log_modal_evidence = by_mesh_error(side_by_side(rows, modal_mesh_.columns), [&](const Eigen::MatrixXd& along) {
    return Laplace(model, along.rightCols(along.cols() - 1), along.col(0), noise_variance_).log_evidence;
  });
  if (!explained.mesh) return out;
  Assessment own = assess(explained, *explained.mesh);
  out.left = std::move(own.left);
  out.test = own.test;
  out.strict_test = own.strict_test;
  return out;
}

Assessment ModelComparison::assess(const Explained& explained, const MeshAllowance& mesh) const {
  const Linearisation& model = explained.linearisation;
  const Eigen::MatrixXd j = side_by_side(model.columns, mesh.columns);
  const Laplace laplace(model, whitened_by(mesh, noise_variance_, frames_, j),
                        whitened_by(mesh, noise_variance_, frames_, explained.error), noise_variance_);
  Assessment out;
  out.log_evidence = model.log_root_weights + laplace.log_evidence;
  out.log_likelihood = model.log_root_weights + laplace.log_likelihood;
  out.left = explained.error - j * laplace.most_probable;
  test_left(static_cast<double>(model.columns.cols()), mesh, out);
  return out;
}

Eigen::MatrixXd ModelComparison::along_modes(const Eigen::MatrixXd& rows) const {
  Eigen::MatrixXd out(modal_frames_.total(), rows.cols());
  for (Eigen::Index k = 0; k < frames_.count(); ++k) {
    const auto [from, size] = frames_[k];
    const auto [first, count] = modal_frames_[k];
    out.middleRows(first, count) = modal_[static_cast<std::size_t>(k)].transpose() * rows.middleRows(from, size);
  }
  return out;
}

Eigen::VectorXd ModelComparison::by_mesh_error(const Eigen::MatrixXd& along,
                                               const std::function<double(const Eigen::MatrixXd&)>& log_evidence) const {
  MeshAllowance mesh = modal_mesh_;
  Eigen::VectorXd out(kModalSizes);
  for (int i = 0; i < kModalSizes; ++i) {
    const double r = size_of_mesh_error(i / (kModalSizes - 1.0)) / kComparison.least_of_mesh;
    mesh.variances = r * r * modal_mesh_.variances;
    out[i] = log_evidence(whitened_by(mesh, noise_variance_, modal_frames_, along));
  }
  return out;
}

void ModelComparison::test_left(double fitted, const MeshAllowance& mesh, Assessment& out) const {
  MisfitTest test = test_of(out.left, fitted);
  const AlongMesh along(mesh, frames_, out.left);
  const double across = mesh.columns.cols() > 0 ? mesh.columns.rightCols(1).squaredNorm() : 0.0;
  const auto z_at = [&, rows = used_.sum()](double size) {
    along.explain(noise_level_, size / kComparison.least_of_mesh, test);
    test.set_numerics(0.0, std::pow(size / kComparison.whole_mesh, 2) * across / rows);
    return test.z();
  };
  std::vector<double> z;
  z.reserve(kSizes);
  for (int i = 0; i < kSizes; ++i) z.push_back(z_at(size_of_mesh_error((i + 0.5) / kSizes)));
  out.test = {averaged_z(z)};
  out.strict_test = {z_at(kComparison.least_of_mesh)};
}

MisfitTest ModelComparison::test_of(const Eigen::VectorXd& error, double fitted) const {
  MisfitTest out = test_where(error, 0, frames_.count(), [](Eigen::Index) { return true; });
  for (std::size_t k = 0; k < differences_.size(); ++k) {
    const auto [from, size] = frames_[static_cast<Eigen::Index>(k)];
    out.add_differences(differences_[k] * error.segment(from, size));
  }
  out.set_fitted(fitted);
  out.tolerate_no_more();
  return out;
}

MisfitTest ModelComparison::test_where(const Eigen::VectorXd& error, Eigen::Index first, Eigen::Index last,
                                       const std::function<bool(Eigen::Index)>& inside) const {
  MisfitTest out;
  out.set_noise(noise_level_);
  for (Eigen::Index k = first; k < last; ++k) {
    std::vector<Eigen::Index> rows;
    const auto range = frames_[k];
    for (Eigen::Index r = range.from; r < range.end(); ++r) {
      if (inside(r)) rows.push_back(r);
    }
    if (rows.empty()) continue;
    const auto size = static_cast<Eigen::Index>(rows.size());
    const Eigen::Index modes = std::min<Eigen::Index>(along_.cols(), std::max<Eigen::Index>(1, size / 4));
    Eigen::VectorXd residual(size), used(size);
    Eigen::MatrixXd shapes(size, modes);
    Eigen::VectorXi nodes(size);
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::Index r = rows[static_cast<std::size_t>(i)];
      residual[i] = error[r];
      used[i] = used_[r];
      shapes.row(i) = along_.row(r).head(modes);
      nodes[i] = nodes_[r];
    }
    out.add(residual, used, with_forces(shapes, nodes));
  }
  return out;
}

ModelComparison common_likelihood(const ModelComparison& one, const ModelComparison& other) {
  const bool first = one.base_cost() <= other.base_cost();
  ModelComparison out = first ? one : other;
  out.note(first ? other : one);
  return out;
}

}  // namespace tissue_stiffness
