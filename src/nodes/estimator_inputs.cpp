#include "nodes/estimator_inputs.hpp"

#include <ros/ros.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "effects/registry.hpp"
#include "nodes/message_conversions.hpp"
#include "nodes/numbered_topic.hpp"
#include "segmentation/lens.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {

std::vector<LoadInput> load_topics(const ModelSettings& settings) {
  std::vector<LoadInput> inputs;
  for (EffectSettings effect : settings.effects) {  // a copy: asking marks keys as known
    if (!effect.arguments.has("topic")) continue;
    const std::string topic = effect.arguments.at("topic").as_text();
    const bool known = std::any_of(inputs.begin(), inputs.end(), [&](const LoadInput& i) { return i.topic == topic; });
    const std::optional<LoadInput::Kind> kind = effect_spec(effect).load;
    if (!known && kind) inputs.push_back({topic, *kind});
  }
  return inputs;
}

EstimatorInputs::EstimatorInputs(const ros::NodeHandle& node, const ModelSettings& settings, SensorPoses& poses,
                                 FrameQueue& queue, Diagnostics& diagnostics)
    : node_(node), settings_(settings), poses_(poses), queue_(queue), diagnostics_(diagnostics) {}

void EstimatorInputs::listen(std::uint32_t queue_size) {
  if (!subscribers_.empty()) return;
  for (const LoadInput& input : load_topics(settings_)) listen_load(input, queue_size);
  std::size_t contours = 0, tracks = 0;
  for (std::size_t i = 0; i < settings_.observations.size(); ++i) {
    const ObservationTraits& traits = traits_of(settings_.observations[i].kind);
    if (settings_.observations[i].kind == ObservationKind::contour) {
      listen_contour(static_cast<int>(i), numbered_topic("contour", ++contours), queue_size);
    } else if (settings_.observations[i].kind == ObservationKind::tracks) {
      listen_tracks(static_cast<int>(i), numbered_topic("tracks", ++tracks), queue_size);
    } else if (traits.force) {
      listen_reaction(static_cast<int>(i), queue_size);
    } else {
      listen_cloud(static_cast<int>(i), queue_size);
    }
  }
}

void EstimatorInputs::set_mesh(const TetMesh& mesh) {
  vertex_count_ = mesh.corner_count;
  body_points_ = make_body_points(settings_, mesh);
  anchors_ = make_feature_anchors(settings_, mesh);
}

// Checks the stamp and hands the message to `add`. Errors in the message are reported and never thrown into the spinner.
template <typename Message, typename Add>
void EstimatorInputs::subscribe(const std::string& topic, std::uint32_t queue_size, Add add) {
  queue_.expect(topic);
  diagnostics_.expect(topic);
  const boost::function<void(const boost::shared_ptr<const Message>&)> callback =
      [this, topic, add](const boost::shared_ptr<const Message>& message) {
        diagnostics_.heard(topic);
        try {
          require_stamp(message->header, topic);
          add(message);
        } catch (const std::exception& error) {
          diagnostics_.bad_message(error.what());
        }
      };
  subscribers_.push_back(node_.subscribe<Message>(topic, queue_size, callback));
}

void EstimatorInputs::listen_cloud(int source, std::uint32_t queue_size) {
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(source)];
  const std::string topic = settings.topic;
  subscribe<sensor_msgs::PointCloud2>(
      topic, queue_size, [this, topic, source, &settings](const sensor_msgs::PointCloud2ConstPtr& cloud) {
        queue_.add_observation(topic, cloud->header.stamp, [this, topic, source, &settings, cloud] {
          Observation out =
              to_observation(*cloud, settings, source, vertex_count_, poses_.model_from(cloud->header, topic));
          select_body(body_points_, settings_, &out);
          return out;
        });
      });
}

void EstimatorInputs::listen_reaction(int source, std::uint32_t queue_size) {
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(source)];
  const std::string topic = settings.topic;
  const auto limit = std::make_shared<RateLimit>(settings.rate);
  subscribe<geometry_msgs::WrenchStamped>(
      topic, 10 * queue_size, [this, topic, source, limit](const geometry_msgs::WrenchStampedConstPtr& wrench) {
        if (!limit->keep(wrench->header.stamp)) return;
        queue_.add_observation(topic, wrench->header.stamp, [this, topic, source, wrench] {
          return to_reaction(*wrench, source, poses_.model_from(wrench->header, topic), topic);
        });
      });
}

void EstimatorInputs::listen_camera(int source) {
  const std::string camera_info = settings_.observations[static_cast<std::size_t>(source)].camera_info;
  const boost::function<void(const sensor_msgs::CameraInfoConstPtr&)> keep =
      [this, camera_info](const sensor_msgs::CameraInfoConstPtr& info) {
        const std::lock_guard<std::mutex> lock(camera_mutex_);
        cameras_[camera_info] = info;
      };
  subscribers_.push_back(node_.subscribe<sensor_msgs::CameraInfo>(camera_info, 10, keep));
}

void EstimatorInputs::listen_contour(int source, const std::string& topic, std::uint32_t queue_size) {
  listen_camera(source);
  subscribe<ContourMessage>(topic, queue_size, [this, topic, source](const ContourConstPtr& contour) {
    queue_.add_observation(topic, contour->header.stamp,
                           [this, topic, source, contour] { return observe_contour(*contour, source, topic); });
  });
}

void EstimatorInputs::listen_tracks(int source, const std::string& topic, std::uint32_t queue_size) {
  listen_camera(source);
  subscribe<FeatureTracksMessage>(
      topic, queue_size, [this, topic, source](const boost::shared_ptr<const FeatureTracksMessage>& tracks) {
        queue_.add_observation(topic, tracks->header.stamp,
                               [this, topic, source, tracks] { return observe_tracks(*tracks, source, topic); });
      });
}

Camera EstimatorInputs::camera_of(const std_msgs::Header& header, int width, int height, int source,
                                  const std::string& topic) const {
  const ObservationSettings& settings = settings_.observations[static_cast<std::size_t>(source)];
  sensor_msgs::CameraInfoConstPtr info;
  {
    const std::lock_guard<std::mutex> lock(camera_mutex_);
    const auto known = cameras_.find(settings.camera_info);
    if (known != cameras_.end()) info = known->second;
  }
  if (!info) throw InputError(topic, "an image before any camera_info", "a message on " + settings.camera_info);
  Camera camera = to_camera(*info, settings, poses_.model_from(header, topic), settings.camera_info);
  require_image_size({width, height}, {camera.width, camera.height}, topic, settings.camera_info);
  return camera;
}

Observation EstimatorInputs::observe_contour(const ContourMessage& message, int source, const std::string& topic) const {
  Observation out;
  out.source = source;
  out.kind = ObservationKind::contour;
  out.time = message.header.stamp.toSec();
  auto contour = std::make_shared<Contour>(to_contour(message, topic));
  out.camera = std::make_shared<Camera>(camera_of(message.header, contour->width, contour->height, source, topic));
  undistort(*out.camera, contour.get());
  out.contour = contour;
  return out;
}

Observation EstimatorInputs::observe_tracks(const FeatureTracksMessage& message, int source, const std::string& topic) {
  FeatureTracks tracks = to_tracks(message, topic);
  const Camera camera = camera_of(message.header, tracks.width, tracks.height, source, topic);
  undistort(camera, &tracks);
  return anchors_.at(source).observe(tracks, camera, source, topic);
}

void EstimatorInputs::listen_load(const LoadInput& input, std::uint32_t queue_size) {
  const std::string topic = input.topic;
  const std::uint32_t deep = 10 * queue_size;  // loads come faster than frames
  if (input.kind == LoadInput::Kind::pressure) {
    subscribe<sensor_msgs::FluidPressure>(topic, deep, [this, topic](const sensor_msgs::FluidPressureConstPtr& pressure) {
      const LoadSample sample = to_load(*pressure, topic);
      queue_.add_load(topic, pressure->header.stamp, [sample] { return sample; });
    });
    return;
  }
  input.kind == LoadInput::Kind::wrench ? listen_posed_load<geometry_msgs::WrenchStamped>(topic, deep)
                                        : listen_posed_load<geometry_msgs::PoseStamped>(topic, deep);
}

template <typename Message>
void EstimatorInputs::listen_posed_load(const std::string& topic, std::uint32_t queue_size) {
  subscribe<Message>(topic, queue_size, [this, topic](const boost::shared_ptr<const Message>& message) {
    queue_.add_load(topic, message->header.stamp,
                    [this, topic, message] { return to_load(*message, poses_.model_from(message->header, topic), topic); });
  });
}

}  // namespace tissue_stiffness
