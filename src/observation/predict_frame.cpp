#include "observation/predict_frame.hpp"

#include <algorithm>
#include <utility>

#include "forward/for_each_index.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kProbe = 1e-4;  // of the body's size: displacement at which the sensors' sensitivity is read

}  // namespace

bool sees_named_nodes(const Model& model, const Frame& frame) {
  return !model.sensors().any() &&
         std::all_of(frame.observations.begin(), frame.observations.end(), [](const Observation& o) {
           const ObservationTraits& traits = traits_of(o.kind);
           return traits.identified || traits.force;
         });
}

Prediction predict_frame(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                         const Frame& frame, const Eigen::VectorXd& theta,
                         const Eigen::Ref<const Eigen::VectorXd>& output) {
  const Eigen::Ref<const Eigen::VectorXd> displacement = output.head(model.fem().dof_count());
  const double since = frame.time - model.loads().first_stamp() - model.settings().time.start;
  const bool observes = model.sensors().any();
  const ObservedMotion seen =
      observes ? model.sensors().observe(theta, since, displacement) : ObservedMotion{model.mesh(), since, {}};
  using Field = Eigen::Ref<const Eigen::VectorXd>;
  const Field u = observes ? Field(seen.displacement) : displacement;
  std::vector<Prediction> parts;
  for (const Observation& observation : frame.observations) {
    const auto& sensor = *operators[static_cast<std::size_t>(observation.source)];
    const ObservationTraits& traits = traits_of(observation.kind);
    parts.push_back(sensor.predict(observation, traits.force ? output : u));
    if (!traits.identified && !traits.force) parts.back().predicted.array() += seen.outward;
  }
  return concatenate_predictions(std::move(parts));
}

Eigen::MatrixXd predict_along(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                              const Frame& frame, const Eigen::VectorXd& theta,
                              const Eigen::Ref<const Eigen::VectorXd>& output, const Prediction& there,
                              const Eigen::MatrixXd& shapes) {
  const Eigen::Matrix3Xd& nodes = model.mesh().nodes;
  const double size = (nodes.rowwise().maxCoeff() - nodes.rowwise().minCoeff()).norm();
  Eigen::MatrixXd out(there.predicted.size(), shapes.cols());
  const auto fill = [&](Eigen::Index i, double largest, Eigen::VectorXd& u, const auto& move) {
    const double probe = kProbe * size / std::max(largest, 1e-300);
    move(probe);
    out.col(i) = (predict_frame(model, operators, frame, theta, u).predicted - there.predicted) / probe;
  };
  if (sees_named_nodes(model, frame)) {  // cheap: only those nodes are moved, one column after the other
    const std::vector<int> nodes = observed_nodes(operators, {frame});
    Eigen::VectorXd u = output;
    for (Eigen::Index i = 0; i < shapes.cols(); ++i) {
      double largest = 0.0;
      for (const int node : nodes) largest = std::max(largest, shapes.col(i).segment<3>(3 * node).cwiseAbs().maxCoeff());
      fill(i, largest, u, [&](double probe) {
        for (const int node : nodes)
          u.segment<3>(3 * node) = output.segment<3>(3 * node) + probe * shapes.col(i).segment<3>(3 * node);
      });
    }
    return out;
  }
  for_each_index(static_cast<std::size_t>(shapes.cols()), [&](std::size_t index) {
    const auto i = static_cast<Eigen::Index>(index);
    Eigen::VectorXd u = output;
    fill(i, shapes.col(i).cwiseAbs().maxCoeff(), u,
         [&](double probe) { u.head(shapes.rows()) = output.head(shapes.rows()) + probe * shapes.col(i); });
  });
  return out;
}

Prediction predict_at_rest(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                           const Frame& frame) {
  return predict_frame(model, operators, frame, model.parameters().theta(model.parameters().prior_mean()), model.rest());
}

}  // namespace tissue_stiffness
