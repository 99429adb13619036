#include "observation/predict_frame.hpp"

#include <algorithm>
#include <utility>

#include "forward/for_each_index.hpp"
#include "types/body_size.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kProbe = 1e-4;  // of the body's size: displacement at which the sensors' sensitivity is read

using Operators = std::vector<std::unique_ptr<ObservationOperator>>;

/// Returns the time of a frame since the model's start [s].
double seconds_since_start(const Model& model, const Frame& frame) {
  return frame.time - model.loads().first_stamp() - model.settings().time.start;
}

/// Returns what sensors show of a displacement that are matched to the body at rest: less what the others show there.
Eigen::VectorXd since_rest(const Model& model, const Eigen::VectorXd& theta, const Eigen::VectorXd& observed) {
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(observed.size());
  return observed - model.sensors().observe(theta, 0.0, rest).displacement;
}

/// How a frame's observations change where the body moves along shapes. Differences are taken where a sensor has no
/// tangent.
class SeenAlong {
 public:
  SeenAlong(const Model& model, const Operators& operators, const Frame& frame, const Eigen::VectorXd& theta,
            const Eigen::Ref<const Eigen::VectorXd>& output, const Eigen::MatrixXd& shapes)
      : model_(model), operators_(operators), frame_(frame), theta_(theta), output_(output), shapes_(shapes) {
    size_ = body_size(model.mesh().nodes);
    if (model.sensors().any()) apparent_ = observe(output.head(model.fem().dof_count()));
  }

  Eigen::MatrixXd rows_of(const Observation& observation) {
    const bool observes = model_.sensors().any();
    using Field = Eigen::Ref<const Eigen::VectorXd>;
    Eigen::VectorXd relative;
    if (observes && traits_of(observation.kind).since_rest) relative = since_rest(model_, theta_, apparent_);
    const Field observed = relative.size() > 0 ? Field(relative) : Field(apparent_);
    const Field u = observes ? observed : Field(output_.head(model_.fem().dof_count()));
    const auto& sensor = *operators_[static_cast<std::size_t>(observation.source)];
    const std::optional<RowTangent> tangent = sensor.tangent(observation, u);
    if (!tangent) return differences(observation);
    return *tangent * (observes ? apparent_shapes() : shapes_);
  }

 private:
  double probe(double largest) const { return kProbe * size_ / std::max(largest, 1e-300); }

  Eigen::VectorXd observe(const Eigen::VectorXd& displacement) const {
    return model_.sensors().observe(theta_, seconds_since_start(model_, frame_), displacement).displacement;
  }

  // The sensors' effects are smooth, and all observations of the frame share them.
  const Eigen::MatrixXd& apparent_shapes() {
    if (apparent_shapes_.cols() > 0) return apparent_shapes_;
    apparent_shapes_.resize(shapes_.rows(), shapes_.cols());
    for_each_index(static_cast<std::size_t>(shapes_.cols()), [&](std::size_t index) {
      const auto i = static_cast<Eigen::Index>(index);
      const double step = probe(shapes_.col(i).cwiseAbs().maxCoeff());
      apparent_shapes_.col(i) = (observe(output_.head(shapes_.rows()) + step * shapes_.col(i)) - apparent_) / step;
    });
    return apparent_shapes_;
  }

  // Only the nodes that the sensor sees are moved, one column after the other.
  Eigen::MatrixXd differences(const Observation& observation) const {
    Frame alone;
    alone.time = frame_.time;
    alone.observations = {observation};
    const auto predict = [&](const Eigen::VectorXd& u) {
      return predict_frame(model_, operators_, alone, theta_, u).predicted;
    };
    const Eigen::VectorXd there = predict(output_);
    const std::vector<int> nodes = observed_nodes(operators_, {alone});
    Eigen::MatrixXd out(there.size(), shapes_.cols());
    Eigen::VectorXd u = output_;
    for (Eigen::Index i = 0; i < shapes_.cols(); ++i) {
      double largest = 0.0;
      for (const int node : nodes) largest = std::max(largest, shapes_.col(i).segment<3>(3 * node).cwiseAbs().maxCoeff());
      const double step = probe(largest);
      for (const int node : nodes)
        u.segment<3>(3 * node) = output_.segment<3>(3 * node) + step * shapes_.col(i).segment<3>(3 * node);
      out.col(i) = (predict(u) - there) / step;
    }
    return out;
  }

  const Model& model_;
  const Operators& operators_;
  const Frame& frame_;
  const Eigen::VectorXd& theta_;
  const Eigen::Ref<const Eigen::VectorXd>& output_;
  const Eigen::MatrixXd& shapes_;
  double size_;
  Eigen::VectorXd apparent_;         ///< displacement as the sensors' effects show it; empty where there are none
  Eigen::MatrixXd apparent_shapes_;  ///< empty until an observation needs them
};

}  // namespace

bool sees_named_nodes(const Model& model, const Frame& frame) {
  return !model.sensors().any() &&
         std::all_of(frame.observations.begin(), frame.observations.end(), [](const Observation& o) {
           const ObservationTraits& traits = traits_of(o.kind);
           return (traits.identified && !traits.image) || traits.force;
         });
}

Prediction predict_frame(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                         const Frame& frame, const Eigen::VectorXd& theta,
                         const Eigen::Ref<const Eigen::VectorXd>& output) {
  const Eigen::Ref<const Eigen::VectorXd> displacement = output.head(model.fem().dof_count());
  const double since = seconds_since_start(model, frame);
  const bool observes = model.sensors().any();
  const ObservedMotion seen =
      observes ? model.sensors().observe(theta, since, displacement) : ObservedMotion{model.mesh(), since, {}};
  using Field = Eigen::Ref<const Eigen::VectorXd>;
  const Field u = observes ? Field(seen.displacement) : displacement;
  std::vector<Prediction> parts;
  for (const Observation& observation : frame.observations) {
    const auto& sensor = *operators[static_cast<std::size_t>(observation.source)];
    const ObservationTraits& traits = traits_of(observation.kind);
    if (observes && traits.since_rest) {
      parts.push_back(sensor.predict(observation, since_rest(model, theta, seen.displacement)));
      continue;
    }
    parts.push_back(sensor.predict(observation, traits.force ? output : u));
    if (!traits.identified && !traits.force) parts.back().predicted.array() += seen.outward;
  }
  return concatenate_predictions(std::move(parts));
}

Eigen::MatrixXd predict_along(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                              const Frame& frame, const Eigen::VectorXd& theta,
                              const Eigen::Ref<const Eigen::VectorXd>& output, const Eigen::MatrixXd& shapes) {
  SeenAlong along(model, operators, frame, theta, output, shapes);
  std::vector<Eigen::MatrixXd> parts;
  Eigen::Index rows = 0;
  for (const Observation& observation : frame.observations) {
    parts.push_back(along.rows_of(observation));
    rows += parts.back().rows();
  }
  Eigen::MatrixXd out(rows, shapes.cols());
  Eigen::Index first = 0;
  for (const Eigen::MatrixXd& part : parts) {
    out.middleRows(first, part.rows()) = part;
    first += part.rows();
  }
  return out;
}

Prediction predict_at_rest(const Model& model, const std::vector<std::unique_ptr<ObservationOperator>>& operators,
                           const Frame& frame) {
  return predict_frame(model, operators, frame, model.parameters().theta(model.parameters().prior_mean()), model.rest());
}

}  // namespace tissue_stiffness
