// simulate, then estimate: the number that went in comes out.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/PointCloud2.h>
#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "report/write_results.hpp"
#include "tools/estimate_recording.hpp"
#include "tools/simulate_scene.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

class RoundTrip : public Workbench {
 protected:
  /// Simulates a bar of `modulus` that is let go under gravity, and estimates it from 2x off.
  EstimationRun run(double modulus, const std::string& observations, const std::string& simulation) {
    const std::string scene = write_model("scene.yaml", std::to_string(modulus), observations, simulation);
    simulate_scene(load_scene(scene), path("recording.bag"), nothing);
    model_ = write_model("model.yaml", "{prior: " + std::to_string(2.0 * modulus) + ", factor: 3}", observations);
    return estimate_recording(load_model(model_), path("recording.bag"), 0, nothing, {});
  }

  /// Copies a recording of 3000 points a frame. It leaves out the far side, and adds a table that the tip nearly
  /// touches, flying pixels, and points without a depth.
  void clutter(const std::string& from, const std::string& to) const {
    rosbag::Bag clean(from), cluttered(to, rosbag::bagmode::Write);
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(0.0F, 1.0F);
    std::normal_distribution<float> noise(0.0F, 5e-4F);
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
    rosbag::View view(clean);
    for (const rosbag::MessageInstance& message : view) {
      const auto cloud = message.instantiate<sensor_msgs::PointCloud2>();
      if (!cloud) {
        cluttered.write(message.getTopic(), message.getTime(), message);
        continue;
      }
      std::vector<std::array<float, 3>> points;
      for (sensor_msgs::PointCloud2ConstIterator<float> p(*cloud, "x"); p != p.end(); ++p) {
        if (p[1] < 0.015F) points.push_back({p[0], p[1], p[2]});
      }
      for (int i = 0; i < 6000; ++i) {
        points.push_back({0.4F * unit(random) - 0.15F, 0.3F * unit(random) - 0.14F, -0.023F + noise(random)});
      }
      for (int i = 0; i < 100; ++i) {
        points.push_back({0.14F * unit(random) - 0.02F, 0.06F * unit(random) - 0.02F, 0.06F * unit(random) - 0.02F});
      }
      for (int i = 0; i < 500; ++i) points.push_back({nan, nan, nan});
      points.push_back({0.0F, infinity, -infinity});
      std::shuffle(points.begin(), points.end(), random);
      sensor_msgs::PointCloud2 out;
      out.header = cloud->header;
      out.is_dense = 1;  // as some drivers say, wrongly
      out.height = 1;
      sensor_msgs::PointCloud2Modifier modifier(out);
      modifier.setPointCloud2Fields(3, "x", 1, sensor_msgs::PointField::FLOAT32, "y", 1, sensor_msgs::PointField::FLOAT32,
                                    "z", 1, sensor_msgs::PointField::FLOAT32);
      modifier.resize(points.size());
      sensor_msgs::PointCloud2Iterator<float> p(out, "x");
      for (const std::array<float, 3>& point : points) {
        std::copy(point.begin(), point.end(), &p[0]);
        ++p;
      }
      cluttered.write(message.getTopic(), message.getTime(), out);
    }
  }

  std::string model_;
};

TEST_F(RoundTrip, FindsTheModulusFromVertices) {
  const EstimationRun run = this->run(4e5, vertices(), "simulation: {duration: 0.4, rate: 60, step: 0.0005}\n");
  ASSERT_EQ(run.results.parameters.size(), 1U);
  EXPECT_NEAR(run.results.parameters[0].mean, 4e5, 0.01 * 4e5);
  EXPECT_NEAR(run.results.rms_error, 2e-4, 0.1 * 2e-4);
  EXPECT_EQ(run.results.used(), 24);
  EXPECT_EQ(run.results.identifiable.at("elasticity.young_modulus").verdict, "absolute");
}

TEST_F(RoundTrip, FindsTheModulusFromMarkersAndPoints) {
  const std::string sensors =
      "- markers: {topic: /markers, noise: 2e-4, rest: [[0.1, 0.01, 0.03], [0.08, 0.03, 0.01]]}\n"
      "- points: {topic: /points, noise: 5e-4}\n";
  const EstimationRun run =
      this->run(4e5, sensors, "simulation: {duration: 0.4, rate: 60, step: 0.0005, sensors: {/points: {count: 100}}}\n");
  EXPECT_NEAR(run.results.parameters.at(0).mean, 4e5, 0.02 * 4e5);
}

TEST_F(RoundTrip, FindsTheModulusFromImages) {
  const EstimationRun run = this->run(8e5, contour(), filmed());
  EXPECT_NEAR(run.results.parameters.at(0).mean, 8e5, 0.05 * 8e5);
  EXPECT_GT(run.stage_samples.count("segment"), 0U);
  ASSERT_EQ(run.showing.pictures.size(), 20U);
  EXPECT_EQ(run.showing.pictures.front().jpeg.substr(0, 2), "\xff\xd8");
  const Replay& replay = run.showing.replays.at(0);
  ASSERT_EQ(replay.outlines.size(), 20U);
  EXPECT_EQ(replay.outlines.front().width, 480);
  EXPECT_GT(replay.outlines.front().predicted.cols(), 4);
  const ReplayTrack& outline = replay.tracks.at(0);
  EXPECT_LT((outline.measured - outline.predicted).cwiseAbs().maxCoeff(), 3.0);  // pixels
}

// An endoscope looks at the bar from above, through its lens.
TEST_F(RoundTrip, FindsTheModulusFromFeaturesOfTheSurface) {
  const EstimationRun run = this->run(
      4e5, "- tracks: {image: /endoscope/image, camera_info: /endoscope/info, noise: 1e-5}\n",
      "simulation: {duration: 0.4, rate: 60, step: 0.0005, sensors: {/endoscope/image: {size: [480, 320], "
      "focal_length: 500, position: [0.06, -0.06, 0.11], target: [0.05, 0.01, 0], distortion: [-0.2, 0.05, 0, 0]}}}\n");
  EXPECT_NEAR(run.results.parameters.at(0).mean, 4e5, 0.02 * 4e5);
  EXPECT_EQ(run.results.used(), 24);
  EXPECT_LT(run.results.rms_error, 1e-4);
  const Replay& replay = run.showing.replays.at(0);
  ASSERT_GT(replay.tracks.size(), 4U);
  EXPECT_EQ(replay.tracks[0].name.substr(0, 8), "feature ");
  EXPECT_EQ(replay.tracks[0].components.size(), 2U);
  EXPECT_EQ(run.showing.pictures.size(), 24U);
  ASSERT_EQ(replay.outlines.size(), 24U);
  EXPECT_FALSE(replay.outlines[9].joined);
  ASSERT_EQ(replay.outlines[9].measured.cols(), replay.outlines[9].predicted.cols());
  EXPECT_LT((replay.outlines[9].measured - replay.outlines[9].predicted.bottomRows<2>()).colwise().norm().maxCoeff(), 1.0);
}

// A wide-angle camera close to the bar. What its lens bends by up to a dozen pixels changes E by less than a hundredth.
TEST_F(RoundTrip, FindsTheSameModulusThroughALens) {
  const auto modulus = [&](const std::string& lens) {
    return run(8e5, contour(),
               "simulation: {duration: 0.5, rate: 80, step: 0.001, sensors: {/camera/image_raw: {size: [640, 320], "
               "focal_length: 500, position: [0.05, -0.11, 0.005], target: [0.05, 0, 0.005]" +
                   lens + "}}}\n")
        .results.parameters.at(0)
        .mean;
  };
  const double without = modulus("");
  EXPECT_NEAR(without, 8e5, 0.05 * 8e5);
  EXPECT_NEAR(modulus(", distortion: [-0.3, 0.1, 0.001, -0.0005, 0]"), without, 0.01 * without);
  EXPECT_NEAR(modulus(", distortion: [0.1, -0.05, 0.02, 0], distortion_model: equidistant"), without, 0.01 * without);
}

// A depth camera sees the bar, the table below it, flying pixels, and pixels without a depth.
TEST_F(RoundTrip, FindsTheModulusFromADepthCamera) {
  const auto points = [](const std::string& more) { return "- points: {topic: /points, noise: 5e-4" + more + "}\n"; };
  const std::string scene =
      write_model("scene.yaml", "4e5", points(""),
                  "simulation: {duration: 0.4, rate: 60, step: 0.0005, sensors: {/points: {count: 3000}}}\n");
  simulate_scene(load_scene(scene), path("clean.bag"), nothing);
  clutter(path("clean.bag"), path("recording.bag"));
  const std::string model =
      write_model("model.yaml", "{prior: 8e5, factor: 3}", points(", depth_camera: {margin: 0.03}"), "inputs: exact\n");
  const EstimationRun run = estimate_recording(load_model(model), path("recording.bag"), 0, nothing, {});
  EXPECT_EQ(run.results.used(), 24);
  EXPECT_NEAR(run.results.parameters.at(0).mean, 4e5, 0.03 * 4e5);
}

// A jaw holds the free end, retracts it and turns it. Only the jaw's pose and the force on it are known.
TEST_F(RoundTrip, FindsTheModulusFromAPoseAndAForce) {
  const auto model = [&](const std::string& name, const std::string& modulus, const std::string& more) {
    return write_bar(name, modulus, ", jaw: {box: {min: [0.099999, -1, -1], max: [1, 1, 1]}}",
                     "- moved: {region: jaw, topic: /jaw/pose, noise: 0, delay: 0}\n"
                     "- viscous_damping: {beta: 0.01}\n",
                     "- reaction: {topic: /jaw/wrench, region: jaw, noise: 2e-3, gain: 0, bias: 0}\n" + more);
  };
  const std::string scene =
      model("scene.yaml", "2.0e4",
            "simulation:\n"
            "  {duration: 1.2, rate: 40, step: 0.001, loads: {/jaw/pose: {rate: 200, position: [0.1, 0, 0],\n"
            "   terms: [{direction: [0.8, 0, 0.6], raised_cosine: {amplitude: 0.004, frequency: 1}},\n"
            "           {axis: [0, 1, 0], raised_cosine: {amplitude: 0.1, frequency: 1}}]}}}\n");
  simulate_scene(load_scene(scene), path("recording.bag"), nothing);
  const EstimationRun run = estimate_recording(load_model(model("model.yaml", "{prior: 5.0e4, factor: 3}", "")),
                                               path("recording.bag"), 0, nothing, {});
  ASSERT_EQ(run.results.parameters.size(), 1U);
  EXPECT_NEAR(run.results.parameters[0].mean, 2e4, 0.01 * 2e4);
  EXPECT_EQ(run.results.identifiable.at("elasticity.young_modulus").verdict, "absolute");
  const ReplayTrack& force = run.showing.replays.at(0).tracks.at(0);
  EXPECT_EQ(force.unit, "N");
  EXPECT_GT(force.measured.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT((force.measured - force.predicted).cwiseAbs().maxCoeff(), 0.02);
}

TEST_F(RoundTrip, GivesTheSameBytesForTheSameInput) {
  const EstimationRun first = run(4e5, vertices(), "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
  const EstimationRun second = estimate_recording(load_model(model_), path("recording.bag"), 0, nothing, {});
  EXPECT_EQ(estimates_csv(first.results), estimates_csv(second.results));
  const std::string bag = read("recording.bag");
  simulate_scene(load_scene(path("scene.yaml")), path("recording.bag"), nothing);
  EXPECT_EQ(bag, read("recording.bag"));
}

TEST_F(RoundTrip, StopsAfterTheFramesAskedFor) {
  run(4e5, vertices(), "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
  EXPECT_EQ(estimate_recording(load_model(model_), path("recording.bag"), 5, nothing, {}).results.frames.size(), 5U);
}

TEST_F(RoundTrip, ASceneThatNeverEndsIsForWhoAsksForIt) {
  const auto scene_of = [&](const std::string& simulation) {
    return load_scene(write_model("scene.yaml", "4e5", vertices(), "simulation: {" + simulation + "}\n"));
  };
  EXPECT_NO_THROW(require_moderate(scene_of("duration: 100, rate: 1000, step: 0.001")));
  for (const std::string simulation : {"duration: 1, rate: 1e6, step: 0.001", "duration: 10, rate: 30, step: 1e-9"})
    EXPECT_TRUE(
        says(input_error([&] { require_moderate(scene_of(simulation)); }), {"simulation", "time steps", "--force"}));
}

TEST_F(RoundTrip, ASceneIsTheTruth) {
  const std::string estimated = write_model("scene.yaml", "{prior: 4e5, factor: 3}", vertices(),
                                            "simulation: {duration: 0.2, rate: 60, step: 0.001}\n");
  EXPECT_TRUE(says(input_error([&] { simulate_scene(load_scene(estimated), path("recording.bag"), nothing); }),
                   {"young_modulus", "an estimated number"}));
}

TEST_F(RoundTrip, ASceneHasNoUnknownKeys) {
  const auto load = [&](const std::string& simulation) {
    return input_error(
        [&] { load_scene(write_model("scene.yaml", "4e5", vertices(), "simulation: " + simulation + "\n")); });
  };
  EXPECT_TRUE(says(load("{duration: 0.2, rate: 60, step: 0.001, refin: 1}"), {"refin", "did you mean `refine`"}));
  EXPECT_TRUE(says(load("{duration: 0.2, rate: 60}"), {"step"}));
  EXPECT_TRUE(says(load("{duration: -1, rate: 60, step: 0.001}"), {"duration", "found -1"}));
  EXPECT_TRUE(
      says(load("{duration: 1, rate: 60, step: 0.001, sensors: {/tissue/vertexes: {every: 2}}}"), {"/tissue/vertexes"}));
}

}  // namespace
}  // namespace tissue_stiffness
