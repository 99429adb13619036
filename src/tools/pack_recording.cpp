#include "tools/pack_recording.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <opencv2/imgproc.hpp>

#include "nodes/estimator_inputs.hpp"
#include "nodes/sensor_conversions.hpp"
#include "tissue_stiffness/types/error.hpp"
#include "tools/camera_file.hpp"
#include "tools/film.hpp"
#include "tools/recording_writer.hpp"
#include "types/read_pose.hpp"
#include "types/read_table.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFirstStamp = 1000.0;  // [s]: a stamp of 0 means that there is none
constexpr double kSameTime = 1e-9;      // [s] between rows of one message
using Write = std::function<void(RecordingWriter&, const ros::Time&)>;

/// One message: its time in the file [s], and what writes it.
struct Message {
  double time;
  Write write;
};
using Messages = std::vector<Message>;

Messages read_points(const PackedTopic& topic, const ObservationSettings& sensor, double scale) {
  const ObservationTraits& traits = traits_of(sensor.kind);
  const std::size_t first = traits.identified ? 2 : 1;
  const std::vector<TableRow> rows =
      read_table(topic.file, first + 3, std::string("time [s], ") + (traits.identified ? "number, " : "") + "x, y, z");
  const std::string id_name = !traits.identified ? "" : sensor.kind == ObservationKind::vertices ? "vertex" : "id";
  Messages out;
  for (std::size_t begin = 0, end = 0; begin < rows.size(); begin = end) {
    while (end < rows.size() && std::abs(rows[end].numbers[0] - rows[begin].numbers[0]) < kSameTime) ++end;
    const auto count = static_cast<Eigen::Index>(end - begin);
    Eigen::Matrix3Xd points(3, count);
    Eigen::VectorXi ids(traits.identified ? count : 0);
    for (Eigen::Index i = 0; i < count; ++i) {
      const TableRow& row = rows[begin + static_cast<std::size_t>(i)];
      points.col(i) = scale * Eigen::Map<const Eigen::Vector3d>(row.numbers.data() + first);
      if (!traits.identified) continue;
      const double id = row.numbers[1];
      if (id != std::floor(id) || id < 0.0 || id > std::numeric_limits<int>::max()) {
        throw InputError(row.where, "the number " + std::to_string(id), "a whole number of at least 0");
      }
      ids[i] = static_cast<int>(id);
    }
    out.push_back({rows[begin].numbers[0], [topic, points, ids, id_name](RecordingWriter& writer, const ros::Time& stamp) {
                     writer.write_cloud(topic.topic, stamp, points, ids, id_name);
                   }});
  }
  return out;
}

Eigen::VectorXd load_value(const TableRow& row, LoadInput::Kind kind, double scale) {
  const double* numbers = row.numbers.data() + 1;
  if (kind == LoadInput::Kind::pressure) return Eigen::VectorXd::Constant(1, numbers[0]);
  if (kind == LoadInput::Kind::wrench) {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(6);
    const auto given = static_cast<Eigen::Index>(std::min<std::size_t>(row.numbers.size() - 1, 6));
    out.head(given) = Eigen::Map<const Eigen::VectorXd>(numbers, given);
    return out;
  }
  Eigen::Matrix<double, 7, 1> pose = Eigen::Map<const Eigen::Matrix<double, 7, 1>>(numbers);
  pose.head<3>() *= scale;
  return read_pose(pose, row.where);
}

Messages read_loads(const PackedTopic& topic, LoadInput::Kind kind, double scale) {
  const bool pose = kind == LoadInput::Kind::pose, pressure = kind == LoadInput::Kind::pressure;
  const std::string what = pose       ? "time [s], x, y, z, qx, qy, qz, qw"
                           : pressure ? "time [s], pressure [Pa]"
                                      : "time [s], fx, fy, fz [N]";
  Messages out;
  for (const TableRow& row : read_table(topic.file, pose ? 8 : pressure ? 2 : 4, what)) {
    const Eigen::VectorXd value = load_value(row, kind, scale);
    out.push_back(
        {row.numbers[0], [input = LoadInput{topic.topic, kind}, value](RecordingWriter& writer, const ros::Time& stamp) {
           writer.write_load(input, stamp, value);
         }});
  }
  return out;
}

Messages read_messages(const ModelSettings& settings, const PackedTopic& topic, double scale) {
  std::string known;
  for (const ObservationSettings& sensor : settings.observations) {
    if (sensor.topic == topic.topic && traits_of(sensor.kind).image) {
      throw InputError("--data " + topic.topic, "a topic of images",
                       "topics of points and loads; --video and --camera take a film");
    }
    if (sensor.topic == topic.topic && traits_of(sensor.kind).force)
      return read_loads(topic, LoadInput::Kind::wrench, scale);
    if (sensor.topic == topic.topic) return read_points(topic, sensor, scale);
    known += (known.empty() ? "" : ", ") + sensor.topic;
  }
  for (const LoadInput& input : load_topics(settings)) {
    if (input.topic == topic.topic) return read_loads(topic, input.kind, scale);
    known += ", " + input.topic;
  }
  throw InputError("--data " + topic.topic, "no topic of " + settings.name, "the model's topics: " + known);
}

std::vector<const ObservationSettings*> contours_of(const ModelSettings& settings) {
  std::vector<const ObservationSettings*> out;
  for (const ObservationSettings& sensor : settings.observations) {
    if (traits_of(sensor.kind).image) out.push_back(&sensor);
  }
  return out;
}

// Decodes each frame when its message is written, because a film may not fit into the memory.
Messages read_film(const PackedFilm& packed, const ObservationSettings& sensor, const std::string& frame) {
  const FilmCamera camera = read_camera_file(packed.camera, sensor);
  auto film = std::make_shared<Film>(packed.film);
  require_image_size(film->size(), {camera.camera.width, camera.camera.height}, packed.film, packed.camera);
  const double rate = camera.rate > 0.0 ? camera.rate : film->rate();
  if (!(rate > 0.0))
    throw InputError(packed.camera, "no key `rate`", "frames a second: " + packed.film + " does not say it");
  const bool coloured = sensor.segmentation.body == SegmentationSettings::Body::colour;
  const std::size_t count = film->count();
  if (count == 0) throw InputError(packed.film, "no frame", "at least one");
  Messages out;
  for (std::size_t k = 0; k < count; ++k) {
    const auto write = [=, image = sensor.topic, info = sensor.camera_info](RecordingWriter& writer,
                                                                            const ros::Time& stamp) {
      if (k == 0) writer.write_pose(frame, stamp, camera.camera.model_from_sensor);
      cv::Mat picture = film->next();
      if (!coloured) cv::cvtColor(picture, picture, cv::COLOR_BGR2GRAY);
      writer.write_image(image, info, frame, stamp, camera.camera, picture);
    };
    out.push_back({camera.start + static_cast<double>(k) / rate, write});
  }
  return out;
}

}  // namespace

PackedTopic read_packed_topic(const std::string& text) {
  const auto at = text.find('=');
  if (at == 0 || at == std::string::npos || at + 1 == text.size()) throw InputError("--data", text, "TOPIC=FILE.csv");
  return {text.substr(0, at), text.substr(at + 1)};
}

std::vector<PackedSummary> pack_recording(const ModelSettings& settings, const PackedFiles& files, const std::string& bag) {
  Messages all;
  std::vector<PackedSummary> summaries;
  const auto add = [&](const std::string& topic, Messages own) {
    const auto earlier = [](const Message& a, const Message& b) { return a.time < b.time; };
    const auto [first, last] = std::minmax_element(own.begin(), own.end(), earlier);
    summaries.push_back({topic, own.size(), last->time - first->time});
    std::move(own.begin(), own.end(), std::back_inserter(all));
  };
  const std::vector<const ObservationSettings*> contours = contours_of(settings);
  if (contours.size() != files.films.size()) {
    throw InputError("--video", std::to_string(files.films.size()) + " films",
                     std::to_string(contours.size()) + ", one for each contour of " + settings.name);
  }
  for (std::size_t k = 0; k < contours.size(); ++k)
    add(contours[k]->topic, read_film(files.films[k], *contours[k], "film_" + std::to_string(k + 1)));
  for (const PackedTopic& topic : files.topics) add(topic.topic, read_messages(settings, topic, files.scale));
  std::stable_sort(all.begin(), all.end(), [](const Message& a, const Message& b) { return a.time < b.time; });
  RecordingWriter writer(bag);
  for (const Message& message : all) message.write(writer, ros::Time(kFirstStamp + message.time - all.front().time));
  writer.close();
  return summaries;
}

}  // namespace tissue_stiffness
