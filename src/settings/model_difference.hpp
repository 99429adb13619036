#pragma once

#include <string>
#include <utility>
#include <vector>

namespace tissue_stiffness {

/// One entry of a model file that another model file lacks, or gives another value.
struct EntryDifference {
  std::string entry;   ///< where it is: "elasticity.young_modulus.prior", "mesh.refine"
  std::string before;  ///< what it says, as YAML in one line; empty: the entry is not there
  std::string after;
};

/// Returns in which entries two model files differ, in the order of `before`, then of `after`. Numbers are compared by
/// value. Files are compared by name, because a model may have moved with its files. Effects and sensors are compared by
/// name; the second of one name is "NAME#2". Throws InputError, naming the line, when a text is no YAML. `names` replace
/// the files' names in messages.
std::vector<EntryDifference> model_difference(const std::string& before, const std::string& after,
                                              const std::pair<std::string, std::string>& names);

}  // namespace tissue_stiffness
