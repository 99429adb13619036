#include "estimation/shared_columns.hpp"

#include <algorithm>
#include <cmath>

namespace tissue_stiffness {
namespace {

// Returns the share of an error's variance that its sensor has in all recordings.
double shared_variance(const std::string& error) {
  if (error == "noise" || error == "torque noise") return 0.0;
  if (error == "gain" || error == "delay" || error == "direction") return 1.0;
  return 0.5;  // bias, hysteresis, pose
}

}  // namespace

SharedColumns::SharedColumns(const Sharing& sharing, const SharedParameters& parameters,
                             const std::vector<OfRecording>& recordings)
    : size_(parameters.size()) {
  std::vector<Entries> entries(recordings.size());
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    const std::vector<Eigen::Index>& columns = parameters.columns(r);
    for (std::size_t i = 0; i < columns.size(); ++i) entries[r].emplace_back(static_cast<Eigen::Index>(i), columns[i], 1.0);
    add_inputs(sharing, r, recordings[r].inputs, entries[r]);
    add_constants(recordings[r].constants);
  }
  first_of_mesh_ = size_;
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    Eigen::Index own = static_cast<Eigen::Index>(parameters.columns(r).size());
    for (const InputGroup& group : recordings[r].inputs) own += group.count;
    const Eigen::Index count = recordings[r].mesh_columns;
    const auto [place, is_new] = places_.try_emplace("mesh " + std::to_string(recordings[r].mesh), size_);
    if (is_new) size_ += count;
    for (Eigen::Index i = 0; i < count; ++i) entries[r].emplace_back(own + i, place->second + i, 1.0);
    maps_.emplace_back(own + count, 0);
  }
  for (std::size_t r = 0; r < recordings.size(); ++r) {
    maps_[r].resize(maps_[r].rows(), size_);
    maps_[r].setFromTriplets(entries[r].begin(), entries[r].end());
  }
}

// Returns the first column of the group, which is new or known by its key.
Eigen::Index SharedColumns::place(const std::string& key, InputGroup group) {
  const auto [place, is_new] = places_.try_emplace(key, size_);
  if (!is_new) return place->second;
  group.first = size_;
  size_ += group.count;
  inputs_.push_back(std::move(group));
  return place->second;
}

void SharedColumns::add_inputs(const Sharing& sharing, std::size_t recording, const std::vector<InputGroup>& groups,
                               Entries& entries) {
  const bool several = sharing.recordings.size() > 1;
  for (const InputGroup& group : groups) {
    const double shared = !several ? 1.0 : sharing.is_own(group.input) ? 0.0 : shared_variance(group.error);
    for (const bool own : {false, true}) {
      const double variance = own ? 1.0 - shared : shared;
      if (variance == 0.0) continue;
      const std::string name = own ? sharing.recordings[recording] : "";
      InputGroup part = group;
      part.tolerance *= std::sqrt(variance);
      if (own) part.input += " (" + name + ")";
      if (group.load >= 0)
        part.load = loads_.try_emplace({group.input, name}, static_cast<int>(loads_.size())).first->second;
      const Eigen::Index first = place(group.input + " " + group.error + " " + name, part);
      for (Eigen::Index i = 0; i < group.count; ++i) entries.emplace_back(group.first + i, first + i, std::sqrt(variance));
    }
  }
}

void SharedColumns::add_constants(const std::vector<UncertainConstant>& constants) {
  constant_columns_.emplace_back();
  for (const UncertainConstant& constant : constants) {
    const auto known = std::find_if(constants_.begin(), constants_.end(), [&](const UncertainConstant& other) {
      return other.name == constant.name && other.value == constant.value && other.std == constant.std;
    });
    constant_columns_.back().push_back(known - constants_.begin());
    if (known == constants_.end()) constants_.push_back(constant);
  }
}

Eigen::VectorXd SharedColumns::constants_of(std::size_t recording, const Eigen::VectorXd& constants) const {
  const std::vector<Eigen::Index>& columns = constant_columns_[recording];
  Eigen::VectorXd out(static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) out[static_cast<Eigen::Index>(i)] = constants[columns[i]];
  return out;
}

NormalEquations SharedColumns::spread(std::size_t recording, const NormalEquations& own) const {
  const Eigen::SparseMatrix<double>& map = maps_[recording];
  NormalEquations out(size_, static_cast<Eigen::Index>(constants_.size()));
  out.information = map.transpose() * own.information * map;
  out.gradient = map.transpose() * own.gradient;
  const Eigen::MatrixXd constants = map.transpose() * own.constants;
  const std::vector<Eigen::Index>& columns = constant_columns_[recording];
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    out.constants.col(columns[i]) = constants.col(k);
    out.constants_gradient[columns[i]] = own.constants_gradient[k];
    for (std::size_t j = 0; j < columns.size(); ++j)
      out.constants_information(columns[i], columns[j]) = own.constants_information(k, static_cast<Eigen::Index>(j));
  }
  out.cost = own.cost;
  out.rows = own.rows;
  out.force_noise = own.force_noise;
  return out;
}

}  // namespace tissue_stiffness
