// Noise that a tracked point carries from one frame to the next.
#include <cmath>

#include "tissue_stiffness/types/error.hpp"
#include "tools/recording_reader.hpp"
#include "tools/simulate_scene.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

class NoiseMemory : public Workbench {
 protected:
  /// 3 x points of every frame.
  std::vector<Eigen::Matrix3Xd> film(const std::string& sensor) {
    const std::string scene =
        write_model("scene.yaml", "4e5", vertices(),
                    "simulation: {duration: 2, rate: 50, step: 0.005, sensors: {/tissue/vertices: " + sensor + "}}\n");
    simulate_scene(load_scene(scene), path("recording.bag"), [](std::size_t, std::size_t) {});
    const ModelSettings model = load_model(write_model("model.yaml", "{prior: 4e5, factor: 2}", vertices()));
    RecordingReader reader(path("recording.bag"), model);
    std::vector<Eigen::Matrix3Xd> frames;
    for (const Frame& frame : read_recording(reader, model, "recording.bag").frames) {
      frames.push_back(frame.observations.front().points);
    }
    return frames;
  }
};

TEST_F(NoiseMemory, HasTheStatedCorrelationAndVariance) {
  const auto plain = film("{noise: 0}"), noisy = film("{noise: 1.0e-3, memory: 0.8}");
  ASSERT_EQ(plain.size(), noisy.size());
  double variance = 0.0, product = 0.0, count = 0.0, pairs = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    const Eigen::Matrix3Xd e = noisy[k] - plain[k];
    variance += e.squaredNorm();
    count += static_cast<double>(e.size());
    if (k == 0) continue;
    product += e.cwiseProduct(noisy[k - 1] - plain[k - 1]).sum();
    pairs += static_cast<double>(e.size());
  }
  EXPECT_NEAR(std::sqrt(variance / count), 1e-3, 1e-4);
  EXPECT_NEAR((product / pairs) / (variance / count), 0.8, 0.05);
}

TEST_F(NoiseMemory, OfOneIsRefused) {
  EXPECT_THROW(film("{memory: 1}"), InputError);
}

}  // namespace
}  // namespace tissue_stiffness
