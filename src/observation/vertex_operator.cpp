// This sensor tracks mesh vertices: h = X + u.
#include "observation/named_points.hpp"
#include "observation/observation_operator.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

class VertexOperator : public ObservationOperator {
 public:
  VertexOperator(const Model& model, const ObservationSettings& settings)
      : mesh_(model.mesh()), topic_(settings.topic), noise_(settings.noise) {}

  void check(const Observation& observation) const override {
    for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
      if (observation.ids[i] < 0 || observation.ids[i] >= mesh_.corner_count) {
        throw InputError(topic_, "vertex " + std::to_string(observation.ids[i]),
                         "0 to " + std::to_string(mesh_.corner_count - 1));
      }
    }
  }

  Prediction predict(const Observation& observation, const Eigen::Ref<const Eigen::VectorXd>& u) const override {
    Prediction p = predict_named_points(observation, noise_);
    for (Eigen::Index i = 0; i < observation.ids.size(); ++i) {
      const int node = observation.ids[i];
      p.predicted.segment<3>(3 * i) = mesh_.nodes.col(node) + u.segment<3>(3 * node);
      p.nodes.segment<3>(3 * i).setConstant(node);
    }
    return p;
  }

  std::vector<int> nodes(const Observation& observation) const override {
    return {observation.ids.data(), observation.ids.data() + observation.ids.size()};
  }

 private:
  const TetMesh& mesh_;
  std::string topic_;
  double noise_;
};

}  // namespace

std::unique_ptr<ObservationOperator> make_vertex_operator(const Model& model, const ObservationSettings& settings) {
  return std::make_unique<VertexOperator>(model, settings);
}

}  // namespace tissue_stiffness
