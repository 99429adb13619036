// Measures the processor time that a depth camera's cloud of 640 x 480 points takes, from the message to the points of the
// body.
#include <sensor_msgs/point_cloud2_iterator.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <random>
#include <vector>

#include "meshing/box_mesh.hpp"
#include "nodes/sensor_conversions.hpp"
#include "observation/body_points.hpp"

namespace ts = tissue_stiffness;

namespace {

constexpr int kWidth = 640, kHeight = 480, kRuns = 100;
constexpr double kFocal = 525.0, kDistance = 0.35, kNoise = 1e-3;  // [pixel], [m], [m]
const Eigen::Vector3d kSize(0.16, 0.1, 0.05);                      // of a block on a table, seen from above [m]

/// A cloud as depth_image_proc makes them: organised, not dense, with NaN where there is no depth.
sensor_msgs::PointCloud2 scene(std::mt19937& random) {
  std::normal_distribution<double> noise(0.0, kNoise);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  sensor_msgs::PointCloud2 cloud;
  cloud.header.stamp = ros::Time(1, 0);
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2FieldsByString(2, "xyz", "rgb");
  modifier.resize(static_cast<std::size_t>(kWidth * kHeight));
  cloud.width = kWidth;
  cloud.height = kHeight;
  cloud.row_step = kWidth * cloud.point_step;
  cloud.is_dense = 0;
  sensor_msgs::PointCloud2Iterator<float> p(cloud, "x");
  for (int i = 0; i < kWidth * kHeight; ++i, ++p) {
    const double u = (i % kWidth - 0.5 * kWidth) / kFocal, v = (i / kWidth - 0.5 * kHeight) / kFocal;
    double depth = kDistance - kSize.z();
    if (std::abs(u * depth) > 0.5 * kSize.x() || std::abs(v * depth) > 0.5 * kSize.y()) depth = kDistance;
    depth += unit(random) < 0.002 ? 0.05 * unit(random) : noise(random);  // some pixels fly
    if (unit(random) < 0.05) depth = std::numeric_limits<double>::quiet_NaN();
    p[0] = static_cast<float>(u * depth);
    p[1] = static_cast<float>(v * depth);
    p[2] = static_cast<float>(depth);
  }
  return cloud;
}

/// Returns the processor time of this thread [ms], which other programs do not lengthen.
double processor_time() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e3 * static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_nsec);
}

}  // namespace

int main() {
  std::mt19937 random(1);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  // the camera looks down on the block's middle
  pose.linear() = Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()).toRotationMatrix();
  pose.translation() << 0.5 * kSize.x(), 0.5 * kSize.y(), kDistance;
  ts::ObservationSettings settings;
  settings.kind = ts::ObservationKind::points;
  settings.topic = "/points";
  settings.noise = kNoise;
  settings.depth_camera = ts::DepthCameraSettings{0.02, 0.0, 4};
  const ts::BodyPoints body(*settings.depth_camera, kNoise, ts::make_box_mesh(kSize, 8, 5, 3));
  std::vector<double> reading, choosing;
  Eigen::Index kept = 0;
  for (int run = 0; run < kRuns; ++run) {
    const sensor_msgs::PointCloud2 cloud = scene(random);
    const double start = processor_time();
    const ts::Observation all = ts::to_observation(cloud, settings, 0, 0, pose);
    const double middle = processor_time();
    kept = body.select(all.points).cols();
    reading.push_back(middle - start);
    choosing.push_back(processor_time() - middle);
  }
  const auto print = [](const char* name, std::vector<double>& times) {
    std::sort(times.begin(), times.end());
    std::printf("| %s | %.1f | %.1f |\n", name, times[times.size() / 2], times[times.size() * 99 / 100]);
  };
  std::puts("| step | median [ms] | p99 [ms] |\n|---|---|---|");
  print("read the message, turn it into the model's frame", reading);
  print("choose the body's points", choosing);
  std::printf("\nIt keeps %d points. At 30 Hz a frame lasts 33 ms.\n", static_cast<int>(kept));
  return 0;
}
