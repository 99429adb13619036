#include "export.hpp"

#include <Eigen/SparseCore>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

namespace tissue_stiffness {
namespace {

class Folder {
 public:
  explicit Folder(std::string path) : path_(std::move(path)) { std::filesystem::create_directories(path_); }

  template <typename Number>
  void write(const std::string& name, const Number* data, Eigen::Index count) const {
    std::ofstream file(path_ + "/" + name + ".bin", std::ios::binary);
    file.write(reinterpret_cast<const char*>(data), count * static_cast<Eigen::Index>(sizeof(Number)));
    if (!file) throw std::runtime_error(path_ + "/" + name + ".bin: cannot be written");
  }
  void write(const std::string& name, SparseMatrix matrix) const {
    matrix.prune(0.0);
    matrix.makeCompressed();
    write(name + "_data", matrix.valuePtr(), matrix.nonZeros());
    write(name + "_indices", matrix.innerIndexPtr(), matrix.nonZeros());
    write(name + "_indptr", matrix.outerIndexPtr(), matrix.outerSize() + 1);
  }
  void write(const nlohmann::json& json) const { std::ofstream(path_ + "/problem.json") << json.dump(1); }

 private:
  std::string path_;
};

// Columns of the identity that belong to free degrees of freedom.
SparseMatrix free_columns(const std::vector<char>& fixed) {
  const auto rows = static_cast<Eigen::Index>(fixed.size());
  SparseMatrix p(rows, rows);
  int column = 0;
  for (Eigen::Index i = 0; i < rows; ++i) {
    if (fixed[static_cast<std::size_t>(i)] == 0) p.insert(i, column++) = 1.0;
  }
  p.conservativeResize(rows, column);
  return p;
}

// Displacement of each marker: six-node shape functions at a facet's centroid.
SparseMatrix observe(const Scene& scene) {
  const auto markers = static_cast<Eigen::Index>(scene.marked_facets.size());
  SparseMatrix h(3 * markers, 3 * scene.mesh.node_count());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < scene.marked_facets.size(); ++i) {
    const auto nodes = scene.mesh.facets.col(scene.marked_facets[i]);
    for (int k = 0; k < 6; ++k) {
      for (int c = 0; c < 3; ++c) {
        entries.emplace_back(static_cast<int>(3 * i) + c, 3 * nodes[k] + c, k < 3 ? -1.0 / 9.0 : 4.0 / 9.0);
      }
    }
  }
  h.setFromTriplets(entries.begin(), entries.end());
  return h;
}

}  // namespace

void export_problem(const Scene& scene, int count, const std::string& path) {
  const Folder folder(path);
  const Model model(scene.settings, scene.mesh);
  const Eigen::VectorXd theta = model.parameters().theta(model.parameters().prior_mean());
  const SparseMatrix p = free_columns(model.fixed());
  const SparseMatrix mass = p.transpose() * model.mass(theta) * p;
  const double modulus = model.parameters().free().front().to_value(model.parameters().prior_mean()[0]);
  const SparseMatrix stiffness = (1.0 / modulus) * (p.transpose() * model.reference_stiffness(theta) * p);
  const SparseMatrix rows = observe(scene) * p;
  folder.write("mass", mass);
  folder.write("stiffness", stiffness);
  folder.write("observe", rows);
  const Eigen::VectorXd push = model.body_acceleration(theta).replicate(scene.mesh.node_count(), 1);
  const Eigen::VectorXd weight = p.transpose() * (model.mass(theta) * push);
  folder.write("weight", weight.data(), weight.size());

  const std::vector<Frame> frames = film(scene, count);
  Eigen::MatrixXd measured(rows.rows(), count);
  for (int k = 0; k < count; ++k) {
    const Eigen::Matrix3Xd moved =
        frames[static_cast<std::size_t>(k)].observations.front().points - scene.settings.observations.front().rest;
    measured.col(k) = Eigen::Map<const Eigen::VectorXd>(moved.data(), moved.size());
  }
  folder.write("measured", measured.data(), measured.size());
  folder.write({{"nodes", scene.mesh.node_count()},
                {"dofs", mass.rows()},
                {"rows", rows.rows()},
                {"frames", count},
                {"interval", kFrameInterval},
                {"noise", kMarkerNoise},
                {"prior", modulus},
                {"truth", kTruth}});
}

}  // namespace tissue_stiffness
