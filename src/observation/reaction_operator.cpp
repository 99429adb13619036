// This sensor measures the force with which a region's prescribed motion, or a tool, acts on the body.
#include <algorithm>

#include "observation/observation_operator.hpp"
#include "settings/suggestion.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

// Returns the first row of the region's reaction in a run's output.
Eigen::Index first_row(const Model& model, const ObservationSettings& settings) {
  const std::string key = model.settings().name + ": observations: reaction.region";
  std::vector<std::string> regions;
  Eigen::Index row = -1;
  for (std::size_t r = 0; r < model.reactions().size(); ++r) {
    regions.push_back(model.reactions()[r].region);
    if (regions.back() != settings.region) continue;
    if (row >= 0) {
      throw InputError(key, settings.region + ", at which two effects act on the body",
                       "a region that only one `moved` or `tool_contact` has; a second name for the same shape will do");
    }
    row = model.fem().dof_count() + 3 * static_cast<Eigen::Index>(r);
  }
  if (row >= 0) return row;
  const std::string there = regions.empty() ? "none in this model" : join_words(regions);
  throw InputError(key, settings.region, "the region of an effect `moved` or `tool_contact`: " + there);
}

class ReactionOperator : public ObservationOperator {
 public:
  ReactionOperator(const Model& model, const ObservationSettings& settings)
      : topic_(settings.topic), noise_(settings.noise), row_(first_row(model, settings)) {}

  void check(const Observation& observation) const override {
    if (observation.points.cols() == 1 && observation.points.allFinite()) return;
    throw InputError(topic_, "a force that is not finite, or more than one", "three finite numbers [N]");
  }

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& output) const override {
    Prediction p;
    p.measured = observation.points.col(0);
    p.predicted = output.segment<3>(row_);
    p.sigma = Eigen::VectorXd::Constant(3, noise_);
    p.places = Eigen::Matrix3Xd::Zero(3, 3);
    p.nodes = Eigen::VectorXi::Constant(3, kForceRow);
    return p;
  }

  std::vector<int> nodes(const Observation&) const override { return {}; }

 private:
  std::string topic_;
  double noise_;
  Eigen::Index row_;
};

}  // namespace

std::unique_ptr<ObservationOperator> make_reaction_operator(const Model& model, const ObservationSettings& settings) {
  return std::make_unique<ReactionOperator>(model, settings);
}

}  // namespace tissue_stiffness
