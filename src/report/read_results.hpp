#pragma once

#include <map>
#include <string>
#include <vector>

namespace tissue_stiffness {

/// What a `results.json` says of the estimated model.
struct SavedResults {
  std::string file;              ///< the results.json
  std::string model, recording;  ///< files of the run, relative to the folder that it ran in
  std::string model_text;        ///< content of the model file
  int nodes = 0, tetrahedra = 0;
  std::map<std::string, double> parameters;  ///< their means
  std::string state, state_reason;
  bool complete = true;
  struct Patch {
    double young_modulus = 0.0;  ///< [Pa]
    bool identified = false;
  };
  std::vector<Patch> patches;  ///< of the map; empty: there is none
  double map_misfit = 0.0;
};

/// Reads a results.json, or the one in a folder. Throws InputError, naming file and key, for what is missing.
SavedResults read_results(const std::string& path);

}  // namespace tissue_stiffness
