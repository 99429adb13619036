#include <Eigen/Geometry>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "meshing/refine.hpp"
#include "observation/closest_point.hpp"
#include "tools/render.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kSuper = 4;  // samples a pixel in each direction
constexpr int kShift = 6;  // fractional bits of drawn coordinates
constexpr double kWall = 150.0, kPool = 14.0, kSurroundings = 45.0, kLost = 0.25;

class EchoRenderer : public Renderer {
 public:
  EchoRenderer(const Model& model, const ObservationSettings& observation, const ImageScene& scene, std::uint64_t seed)
      : scene_(scene), seed_(seed), tets_(refine_mesh(model.mesh()).tets.topRows(4)) {  // linear pieces between all nodes
    const auto region = model.body().regions.find(observation.region);
    const SurfaceTriangles surface = region == model.body().regions.end()
                                         ? split_facets(model.mesh())
                                         : split_facets(model.mesh(), region->second.facets);
    triangles_ = surface.nodes;
    draw_beams();
  }

  cv::Mat draw(const Eigen::Matrix3Xd& positions, int frame) const override {
    const Eigen::Matrix3Xd local = scene_.camera.model_from_sensor.inverse() * positions;
    const cv::Size size(scene_.camera.width, scene_.camera.height);
    cv::Mat wall = cv::Mat::zeros(kSuper * size.height, kSuper * size.width, CV_8U), pool = wall.clone();
    for (Eigen::Index t = 0; t < tets_.cols(); ++t) fill_cut(tets_.col(t), local, wall);
    fill_pool(local, pool);
    cv::Mat level(wall.size(), CV_32F, cv::Scalar(kSurroundings));
    level.setTo(kPool, pool);
    level.setTo(kWall, wall);
    cv::Mat small, image;
    cv::resize(level, small, size, 0, 0, cv::INTER_AREA);
    // A lost beam shows neither wall nor surroundings.
    small = small.mul(gain_).mul(speckle(frame));
    if (scene_.blur > 0.0) cv::GaussianBlur(small, small, cv::Size(), scene_.blur);
    cv::RNG random(seed_ + 2 + static_cast<std::uint64_t>(frame));
    cv::Mat noise(size, CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0.0, scene_.noise);
    small += noise;
    small.setTo(0.0, outside_);
    small.convertTo(image, CV_8U);
    return image;
  }

 private:
  void draw_beams() {
    const Camera& camera = scene_.camera;
    gain_ = cv::Mat(camera.height, camera.width, CV_32F, cv::Scalar(1.0));
    outside_ = cv::Mat::zeros(camera.height, camera.width, CV_8U);
    cv::RNG random(seed_);
    const double width = 0.5 * scene_.drop_out * scene_.sector;  // two windows
    const double first = random.uniform(-0.45, -0.05) * scene_.sector, second = random.uniform(0.05, 0.4) * scene_.sector;
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const double x = u - scene_.apex.x(), y = v - scene_.apex.y(), angle = std::atan2(x, y);
        if (std::abs(angle) > 0.5 * scene_.sector || std::hypot(x, y) > scene_.depth) outside_.at<uchar>(v, u) = 255;
        const bool lost = (angle >= first && angle < first + width) || (angle >= second && angle < second + width);
        if (lost) gain_.at<float>(v, u) = static_cast<float>(kLost);
      }
    }
  }

  cv::Point to_super(const Eigen::Vector2d& local) const {
    const Camera& camera = scene_.camera;
    const double u = camera.fx * local.x() + camera.cx, v = camera.fy * local.y() + camera.cy;
    const double scale = 1 << kShift;
    return {static_cast<int>(std::lround(scale * (kSuper * (u + 0.5) - 0.5))),
            static_cast<int>(std::lround(scale * (kSuper * (v + 0.5) - 0.5)))};
  }

  /// Returns the points where the plane z = 0 cuts the edges between the nodes.
  template <typename Nodes>
  std::vector<cv::Point> cut(const Nodes& nodes, const Eigen::Matrix3Xd& local) const {
    std::vector<cv::Point> points;
    for (Eigen::Index i = 0; i < nodes.size(); ++i) {
      for (Eigen::Index j = i + 1; j < nodes.size(); ++j) {
        const Eigen::Vector3d a = local.col(nodes[i]), b = local.col(nodes[j]);
        if ((a.z() > 0.0) == (b.z() > 0.0)) continue;
        points.push_back(to_super((a + a.z() / (a.z() - b.z()) * (b - a)).head<2>()));
      }
    }
    return points;
  }

  template <typename Nodes>
  void fill_cut(const Nodes& nodes, const Eigen::Matrix3Xd& local, cv::Mat& mask) const {
    const std::vector<cv::Point> points = cut(nodes, local);
    if (points.size() < 3) return;
    std::vector<cv::Point> polygon;
    cv::convexHull(points, polygon);
    cv::fillConvexPoly(mask, polygon, cv::Scalar(255), cv::LINE_8, kShift);
  }

  // The pool is the hull of the cavity's outline, so it is closed where the wall is open.
  void fill_pool(const Eigen::Matrix3Xd& local, cv::Mat& mask) const {
    std::vector<cv::Point> outline, hull;
    for (Eigen::Index t = 0; t < triangles_.cols(); ++t) {
      for (const cv::Point& point : cut(triangles_.col(t), local)) outline.push_back(point);
    }
    if (outline.size() < 3) return;
    cv::convexHull(outline, hull);
    cv::fillConvexPoly(mask, hull, cv::Scalar(255), cv::LINE_8, kShift);
  }

  // Returns log-compressed Rayleigh speckle with mean 1, wider across the beam than along it.
  cv::Mat speckle(int frame) const {
    cv::RNG random(seed_ + 1000003u * (1 + static_cast<std::uint64_t>(frame)));
    cv::Mat real(gain_.size(), CV_32F), imaginary(gain_.size(), CV_32F), magnitude;
    for (cv::Mat* part : {&real, &imaginary}) {
      random.fill(*part, cv::RNG::NORMAL, 0.0, 1.0);
      cv::GaussianBlur(*part, *part, cv::Size(), 2.0, 1.0);
    }
    cv::magnitude(real, imaginary, magnitude);
    cv::pow(magnitude, 0.6, magnitude);
    return magnitude / cv::mean(magnitude)[0];
  }

  ImageScene scene_;
  std::uint64_t seed_;
  Eigen::MatrixXi tets_;
  Eigen::Matrix3Xi triangles_;
  cv::Mat gain_, outside_;
};

}  // namespace

std::unique_ptr<Renderer> make_echo_renderer(const Model& model, const ObservationSettings& observation,
                                             const ImageScene& scene, std::uint64_t seed) {
  return std::make_unique<EchoRenderer>(model, observation, scene, seed);
}

}  // namespace tissue_stiffness
