#include "observation/observation_operator.hpp"

#include <set>
#include <utility>

namespace tissue_stiffness {

std::vector<std::unique_ptr<ObservationOperator>> make_observation_operators(const Model& model) {
  std::vector<std::unique_ptr<ObservationOperator>> operators;
  for (const ObservationSettings& settings : model.settings().observations) {
    switch (settings.kind) {
      case ObservationSettings::Kind::vertices:
        operators.push_back(make_vertex_operator(model, settings));
        break;
      case ObservationSettings::Kind::markers:
        operators.push_back(make_marker_operator(model, settings));
        break;
      case ObservationSettings::Kind::points:
        operators.push_back(make_point_operator(model, settings));
        break;
      case ObservationSettings::Kind::contour:
        operators.push_back(make_contour_operator(model, settings));
        break;
      case ObservationSettings::Kind::tracks:
        operators.push_back(make_track_operator(model, settings));
        break;
      case ObservationSettings::Kind::reaction:
        operators.push_back(make_reaction_operator(model, settings));
        break;
    }
  }
  return operators;
}

std::vector<int> observed_nodes(const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                                const std::vector<Frame>& frames) {
  std::set<int> all;
  for (const Frame& frame : frames) {
    for (const Observation& observation : frame.observations) {
      const std::vector<int> nodes = operators[static_cast<std::size_t>(observation.source)]->nodes(observation);
      all.insert(nodes.begin(), nodes.end());
    }
  }
  return {all.begin(), all.end()};
}

Prediction concatenate_predictions(std::vector<Prediction> parts) {
  if (parts.size() == 1) return std::move(parts.front());
  Eigen::Index rows = 0;
  for (const Prediction& part : parts) rows += part.measured.size();
  Prediction all;
  all.measured.resize(rows);
  all.predicted.resize(rows);
  all.sigma.resize(rows);
  all.places.resize(3, rows);
  all.nodes.resize(rows);
  Eigen::Index at = 0;
  for (const Prediction& part : parts) {
    const Eigen::Index n = part.measured.size();
    all.measured.segment(at, n) = part.measured;
    all.predicted.segment(at, n) = part.predicted;
    all.sigma.segment(at, n) = part.sigma;
    all.places.middleCols(at, n) = part.places;
    all.nodes.segment(at, n) = part.nodes;
    at += n;
  }
  return all;
}

}  // namespace tissue_stiffness
