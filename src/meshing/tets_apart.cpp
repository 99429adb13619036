#include "meshing/tets_apart.hpp"

#include <cstdint>
#include <cstring>
#include <string>

#include "meshing/run_apart.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

template <typename Matrix>
void append(std::string& bytes, const Matrix& matrix) {
  const std::int64_t size[2] = {matrix.rows(), matrix.cols()};
  bytes.append(reinterpret_cast<const char*>(size), sizeof(size));
  const std::size_t count = sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(matrix.size());
  if (count > 0) bytes.append(reinterpret_cast<const char*>(matrix.data()), count);
}

template <typename Matrix>
std::size_t extract(const std::string& bytes, std::size_t at, Matrix& matrix) {
  std::int64_t size[2];
  std::memcpy(size, bytes.data() + at, sizeof(size));
  matrix.resize(size[0], size[1]);
  const std::size_t count = sizeof(typename Matrix::Scalar) * static_cast<std::size_t>(matrix.size());
  if (count > 0) std::memcpy(matrix.data(), bytes.data() + at + sizeof(size), count);  // an empty matrix has no data
  return at + sizeof(size) + count;
}

std::string mesh_or_message(const std::function<TetFile()>& make) {
  try {
    const TetFile mesh = make();
    std::string bytes = "M";
    append(bytes, mesh.nodes);
    append(bytes, mesh.tets);
    return bytes;
  } catch (const InputError& error) {
    return std::string("E") + error.what();
  }
}

}  // namespace

std::optional<TetFile> make_tets_apart(const std::function<TetFile()>& make, unsigned seconds,
                                       const std::function<void()>& checkpoint) {
  const auto result = run_apart([&] { return mesh_or_message(make); }, seconds, checkpoint);
  if (!result || result->empty()) return std::nullopt;
  if (result->front() == 'E') throw InputError(result->substr(1));
  TetFile mesh;
  extract(*result, extract(*result, 1, mesh.nodes), mesh.tets);
  return mesh;
}

}  // namespace tissue_stiffness
