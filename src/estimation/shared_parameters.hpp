#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <vector>

#include "forward/model.hpp"

namespace tissue_stiffness {

/// Says what recordings of one body have in common: everything but what `own` names and what belongs to a recording by its
/// nature, such as an initial motion.
struct Sharing {
  std::vector<std::string> recordings;  ///< their names
  std::vector<std::string> own;         ///< effects, their parameters, and topics that each recording has for itself

  /// Returns whether `own` holds the name, or the effect that it begins with.
  bool is_own(const std::string& name) const;
};

/// The free parameters of several recordings of one body. Those of one name are one parameter, unless each recording has
/// its own.
class SharedParameters {
 public:
  struct Parameter {
    FreeParameter free;
    int recording = -1;  ///< the one that it belongs to; -1: to all that have it
  };

  /// Throws InputError where a shared parameter has different priors, and where `own` names nothing.
  SharedParameters(const Sharing& sharing, const std::vector<const Model*>& models);

  const std::vector<Parameter>& all() const { return all_; }
  std::vector<FreeParameter> free() const;
  Eigen::Index size() const { return static_cast<Eigen::Index>(all_.size()); }
  /// Returns the place in all() of each parameter of a recording.
  const std::vector<Eigen::Index>& columns(std::size_t recording) const { return columns_[recording]; }
  Eigen::VectorXd prior_mean() const;
  Eigen::VectorXd prior_std() const;
  /// Returns a recording's part of w.
  Eigen::VectorXd of(std::size_t recording, const Eigen::VectorXd& w) const;

 private:
  Eigen::Index add(const Sharing& sharing, const FreeParameter& free, int recording, bool own);

  std::vector<Parameter> all_;
  std::vector<std::vector<Eigen::Index>> columns_;
};

}  // namespace tissue_stiffness
