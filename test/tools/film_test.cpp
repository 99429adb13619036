#include <cv_bridge/cv_bridge.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Image.h>

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>
#include <sstream>
#include <vector>

#include "tissue_stiffness/types/error.hpp"
#include "tools/bag_reader.hpp"
#include "tools/camera_file.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/pack_recording.hpp"
#include "tools/simulate_scene.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

const char* const kCamera =
    "image_width: 480\n"
    "image_height: 240\n"
    "camera_name: endoscope\n"
    "camera_matrix: {rows: 3, cols: 3, data: [3000, 0, 239.5, 0, 3000, 119.5, 0, 0, 1]}\n"
    "distortion_model: plumb_bob\n"
    "distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}\n"
    "pose: [0.05, -1, 0.005, -0.70710678, 0, 0, 0.70710678]\n";

class FilmTest : public Workbench {
 protected:
  // A bright bar on a dark ground, which moves to the right by 2 pixels a frame.
  static cv::Mat frame(int k, const cv::Scalar& colour) {
    cv::Mat out(240, 480, CV_8UC3, cv::Scalar(10, 10, 10));
    cv::rectangle(out, {100 + 2 * k, 90}, {300 + 2 * k, 150}, colour, cv::FILLED);
    return out;
  }
  void write_film(const std::string& name, const std::vector<cv::Mat>& frames, double rate) const {
    cv::VideoWriter film(path(name), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), rate, frames.front().size());
    ASSERT_TRUE(film.isOpened());
    for (const cv::Mat& image : frames) film.write(image);
  }
  ModelSettings model(const std::string& segmentation = "") const {
    std::string observation = contour();
    if (!segmentation.empty()) observation.insert(observation.rfind('}'), ", segmentation: " + segmentation);
    return load_model(write_model("model.yaml", "{prior: 16e5, factor: 3}", observation));
  }
  std::vector<PackedSummary> pack(const ModelSettings& settings, const std::string& film, const std::string& camera) const {
    return pack_recording(settings, {{}, {{path(film), write("camera.yaml", camera)}}, 1.0}, path("packed.bag"));
  }
  std::string refused(const std::string& film, const std::string& camera) const {
    return input_error([&] { pack(model(), film, camera); });
  }
};

TEST_F(FilmTest, GivesTheModulusThatItsImagesGive) {
  const std::string scene = write_model("scene.yaml", "8e5", contour(), filmed());
  simulate_scene(load_scene(scene), path("recording.bag"), nothing);
  std::vector<cv::Mat> frames;
  rosbag::Bag bag(path("recording.bag"));
  rosbag::View view(bag, rosbag::TypeQuery("sensor_msgs/Image"));
  for (const rosbag::MessageInstance& message : view)
    frames.push_back(cv_bridge::toCvCopy(message.instantiate<sensor_msgs::Image>(), "bgr8")->image);
  write_film("film.avi", frames, 50.0);
  const ModelSettings settings = model();
  const std::vector<PackedSummary> packed = pack(settings, "film.avi", kCamera);
  ASSERT_EQ(packed.size(), 1U);
  EXPECT_EQ(packed[0].topic, "/camera/image_raw");
  EXPECT_EQ(packed[0].messages, frames.size());
  EXPECT_NEAR(packed[0].duration, static_cast<double>(frames.size() - 1) / 50.0, 1e-9);
  const auto modulus = [&](const std::string& name) {
    return estimate_recording(settings, path(name), 0, nothing, {}).results.parameters.at(0).mean;
  };
  const double images = modulus("recording.bag");
  EXPECT_NEAR(images, 8e5, 0.05 * 8e5);
  EXPECT_NEAR(modulus("packed.bag"), images, 0.01 * images);
}

TEST_F(FilmTest, MayBeNumberedImagesBesideOtherFiles) {
  for (int k = 0; k < 4; ++k) {
    std::ostringstream name;
    name << "frame_" << k << ".png";
    cv::imwrite(path(name.str()), frame(k, {40, 40, 200}));
  }
  const ModelSettings settings = model("{kind: silhouette, body: colour, colour: [200, 40, 40]}");
  const std::string camera = std::string(kCamera) + "rate: 20\nstart: 1.5\n";
  const std::vector<PackedSummary> packed = pack(settings, "frame_%d.png", camera);
  EXPECT_EQ(packed.at(0).messages, 4U);
  BagReader reader(path("packed.bag"), settings);
  std::vector<Frame> frames;
  while (auto instant = reader.next()) {
    ASSERT_EQ(instant->reason, "");
    frames.push_back(instant->frame);
  }
  ASSERT_EQ(frames.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_NEAR(frames[k].time - frames[0].time, 0.05 * static_cast<double>(k), 1e-6);
    const Observation& seen = frames[k].observations.at(0);
    ASSERT_TRUE(seen.contour);
    const Eigen::VectorXd u = seen.contour->points.row(0).transpose();
    EXPECT_NEAR(0.5 * (u.minCoeff() + u.maxCoeff()), 200.0 + 2.0 * static_cast<double>(k), 1.0);
    ASSERT_TRUE(seen.camera);
    EXPECT_NEAR((seen.camera->model_from_sensor.translation() - Eigen::Vector3d(0.05, -1, 0.005)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(seen.camera->project({0.05, 0, 0.005}).x(), 239.5, 1e-3);
    EXPECT_NEAR(seen.camera->project({0.05, 0, 0.005}).y(), 119.5, 1e-3);
    EXPECT_GT(seen.camera->project({0.06, 0, 0.005}).x(), 240.0);
    EXPECT_LT(seen.camera->project({0.05, 0, 0.01}).y(), 119.0);
  }
}

TEST_F(FilmTest, NamesWhatDoesNotFit) {
  write_film("film.avi", {frame(0, {200, 200, 200}), frame(1, {200, 200, 200})}, 25.0);
  cv::imwrite(path("frame_0.png"), frame(0, {200, 200, 200}));
  const auto with = [](const std::string& from, const std::string& to) {
    std::string text = kCamera;
    return text.replace(text.find(from), from.size(), to);
  };
  EXPECT_EQ(refused("film.avi", kCamera), "");
  EXPECT_TRUE(says(refused("none.mp4", kCamera), {"none.mp4", "no film that OpenCV decodes"}));
  EXPECT_TRUE(says(refused("film.avi", with("480", "640")), {"film.avi", "480 x 240", "640 x 240", "camera.yaml"}));
  EXPECT_TRUE(says(refused("frame_%d.png", kCamera), {"camera.yaml", "rate"}));
  EXPECT_TRUE(says(refused("film.avi", std::string(kCamera) + "rate: 0\n"), {"camera.yaml:8: rate", "found 0"}));
  EXPECT_TRUE(says(refused("film.avi", std::string(kCamera) + "sped: 2\n"), {"camera.yaml:8: sped", "unknown key"}));
  EXPECT_TRUE(says(refused("film.avi", with("pose:", "position:")), {"camera.yaml", "no key `pose`"}));
  EXPECT_TRUE(says(refused("film.avi", with("0.70710678]", "0.9]")), {"camera.yaml:7: pose", "length 1"}));
  EXPECT_TRUE(says(refused("film.avi", with("239.5, 0,", "239.5, 0.1,")), {"camera_matrix.data", "[fx, 0, cx"}));
  EXPECT_TRUE(says(refused("film.avi", with("plumb_bob", "fisheye")), {"camera.yaml:5: distortion_model", "plumb_bob"}));
  const auto packed = [&](const PackedFiles& files) {
    return input_error([&] { pack_recording(model(), files, path("packed.bag")); });
  };
  EXPECT_TRUE(says(packed({}), {"--video", "0 films", "1, one for each contour of"}));
  write("camera.yaml", kCamera);
  EXPECT_TRUE(says(packed({{{"/camera/image_raw", path("a.csv")}}, {{path("film.avi"), path("camera.yaml")}}, 1.0}),
                   {"--data /camera/image_raw", "--video"}));
}

}  // namespace
}  // namespace tissue_stiffness
