#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>

#include "observation/closest_point.hpp"
#include "segmentation/lens.hpp"
#include "tools/render.hpp"
#include "types/sensor_ray.hpp"

namespace tissue_stiffness {
namespace {

constexpr int kSuper = 4;  // samples a pixel in each direction
constexpr double kAmbient = 95.0, kLit = 85.0, kTexture = 14.0;
constexpr double kBackground = 60.0, kClouds = 14.0, kFloor = 95.0;

/// Returns a smooth random field of unit variance, which is a sum of octaves of enlarged coarse noise.
cv::Mat cloudy(int width, int height, cv::RNG& random) {
  cv::Mat sum = cv::Mat::zeros(height, width, CV_32F);
  double variance = 0.0, weight = 1.0;
  for (int cell = width / 4; cell >= 4; cell /= 2, weight *= 0.6) {
    cv::Mat coarse(height / cell + 3, width / cell + 3, CV_32F), fine;
    random.fill(coarse, cv::RNG::NORMAL, 0.0, 1.0);
    cv::resize(coarse, fine, cv::Size(coarse.cols * cell, coarse.rows * cell), 0, 0, cv::INTER_CUBIC);
    sum += weight * fine(cv::Rect(0, 0, width, height));
    variance += weight * weight;
  }
  return sum / std::sqrt(variance);
}

/// Pattern that is fixed to the body. It consists of waves in random directions of the rest position.
class Texture {
 public:
  Texture() = default;
  Texture(double size, cv::RNG& random) {
    for (Wave& wave : waves_) {
      const double number = 2.0 * M_PI * random.uniform(4.0, 25.0) / size;
      wave.vector = Eigen::Vector3d(random.gaussian(1), random.gaussian(1), random.gaussian(1)).normalized() * number;
      wave.phase = random.uniform(0.0, 2.0 * M_PI);
    }
  }
  double at(const Eigen::Vector3d& rest) const {
    double sum = 0.0;
    for (const Wave& wave : waves_) sum += std::sin(wave.vector.dot(rest) + wave.phase);
    return sum / std::sqrt(0.5 * static_cast<double>(waves_.size()));
  }

 private:
  struct Wave {
    Eigen::Vector3d vector;
    double phase;
  };
  std::array<Wave, 8> waves_;
};

struct Plane {
  Eigen::Vector3d point, normal;
};

std::optional<Plane> floor_of(const ModelSettings& settings) {
  for (const EffectSettings& effect : settings.effects) {
    if (effect.name != "contact_plane") continue;
    return Plane{effect.arguments.at("point").as_vector3("m"), effect.arguments.at("normal").as_vector3("")};
  }
  return std::nullopt;
}

class CameraRenderer : public Renderer {
 public:
  CameraRenderer(const Model& model, const ImageScene& scene, std::uint64_t seed)
      : mesh_(model.mesh()), scene_(scene), seed_(seed), triangles_(split_facets(mesh_)) {
    cv::RNG random(seed);
    const Eigen::Vector3d low = mesh_.nodes.rowwise().minCoeff(), high = mesh_.nodes.rowwise().maxCoeff();
    texture_ = Texture((high - low).norm(), random);
    at_nodes_ = Eigen::VectorXd::Zero(mesh_.node_count());
    for (int i = 0; i < mesh_.node_count() && !scene.fine; ++i) at_nodes_[i] = texture_.at(mesh_.nodes.col(i));
    const Camera& camera = scene.camera;
    background_ = kBackground + kClouds * cloudy(camera.width, camera.height, random);
    if (const auto plane = floor_of(model.settings())) draw_floor(*plane, 0.5 * (low + high));
    cv::resize(background_, background_, cv::Size(kSuper * camera.width, kSuper * camera.height), 0, 0, cv::INTER_NEAREST);
  }

  cv::Mat draw(const Eigen::Matrix3Xd& positions, int frame) const override {
    cv::Mat grey = background_.clone();
    cv::Mat depth(grey.size(), CV_32F, cv::Scalar(std::numeric_limits<float>::max()));
    const Eigen::Matrix3Xd local = scene_.camera.model_from_sensor.inverse() * positions;
    const Eigen::VectorXd shade = shades(local);
    const Eigen::Matrix2Xd pixels = pixels_of(local);
    for (Eigen::Index t = 0; t < triangles_.nodes.cols(); ++t) {
      fill(triangles_.nodes.col(t), local, pixels, shade, grey, depth);
    }
    cv::Mat small, image;
    cv::resize(grey, small, cv::Size(scene_.camera.width, scene_.camera.height), 0, 0, cv::INTER_AREA);
    if (scene_.blur > 0.0) cv::GaussianBlur(small, small, cv::Size(), scene_.blur);
    cv::RNG random(seed_ + 1 + static_cast<std::uint64_t>(frame));
    cv::Mat noise(small.size(), CV_32F);
    random.fill(noise, cv::RNG::NORMAL, 0.0, scene_.noise);
    small += noise;
    small.convertTo(image, CV_8U);
    return image;
  }

 private:
  // Draws the plane's near edge, at the depth of the body's centre.
  void draw_floor(const Plane& plane, const Eigen::Vector3d& centre) {
    const Camera& camera = scene_.camera;
    const double depth = depth_of(camera, centre);
    Eigen::Matrix2Xd pixels(2, Eigen::Index{camera.width} * camera.height);
    for (Eigen::Index i = 0; i < pixels.cols(); ++i) {
      const Eigen::Index row = i / camera.width;
      pixels.col(i) << static_cast<double>(i % camera.width), static_cast<double>(row);
    }
    pixels = undistort(camera, pixels);
    for (int v = 0; v < camera.height; ++v) {
      for (int u = 0; u < camera.width; ++u) {
        const Eigen::Vector2d pixel = pixels.col(Eigen::Index{v} * camera.width + u);
        if ((place_of(camera, pixel, depth) - plane.point).dot(plane.normal) < 0.0) {
          background_.at<float>(v, u) += static_cast<float>(kFloor - kBackground);
        }
      }
    }
  }

  Eigen::VectorXd shades(const Eigen::Matrix3Xd& local) const {
    Eigen::Matrix3Xd normals = Eigen::Matrix3Xd::Zero(3, local.cols());
    for (Eigen::Index t = 0; t < triangles_.nodes.cols(); ++t) {
      const Eigen::Vector3i n = triangles_.nodes.col(t);
      const Eigen::Vector3d area = (local.col(n[1]) - local.col(n[0])).cross(local.col(n[2]) - local.col(n[0]));
      for (int i = 0; i < 3; ++i) normals.col(n[i]) += area;
    }
    static const Eigen::Vector3d to_light = Eigen::Vector3d(-0.3, -0.5, -0.8).normalized();
    Eigen::VectorXd out(local.cols());
    for (Eigen::Index i = 0; i < local.cols(); ++i) {
      out[i] = kAmbient + kLit * std::max(0.0, normals.col(i).normalized().dot(to_light)) + kTexture * at_nodes_[i];
    }
    return out;
  }

  /// Returns where the camera sees the nodes, through its lens.
  Eigen::Matrix2Xd pixels_of(const Eigen::Matrix3Xd& local) const {
    const Camera& camera = scene_.camera;
    Eigen::Matrix2Xd pixels(2, local.cols());
    pixels.row(0) = camera.fx * local.row(0).array() / local.row(2).array() + camera.cx;
    pixels.row(1) = camera.fy * local.row(1).array() / local.row(2).array() + camera.cy;
    return distort(camera, pixels);
  }

  // Fills a triangle by barycentric rasterisation with a depth buffer. The lens bends its edges, but they are short.
  void fill(const Eigen::Vector3i& nodes, const Eigen::Matrix3Xd& local, const Eigen::Matrix2Xd& pixels,
            const Eigen::VectorXd& shade, cv::Mat& grey, cv::Mat& depth) const {
    Eigen::Matrix<double, 2, 3> p;
    Eigen::Matrix3d rest;
    for (int i = 0; i < 3; ++i) {
      rest.col(i) = mesh_.nodes.col(nodes[i]);
      if (local(2, nodes[i]) <= 0.0) return;
      p.col(i) = kSuper * (pixels.col(nodes[i]).array() + 0.5) - 0.5;
    }
    Eigen::Matrix2d edges;
    edges << p.col(1) - p.col(0), p.col(2) - p.col(0);
    if (std::abs(edges.determinant()) < 1e-9) return;
    const Eigen::Matrix2d inverse = edges.inverse();
    const auto clamp = [](double value, int upper) {
      return static_cast<int>(std::min<double>(std::max(value, 0.0), upper));
    };
    const int u0 = clamp(std::ceil(p.row(0).minCoeff()), grey.cols),
              u1 = clamp(std::floor(p.row(0).maxCoeff()) + 1, grey.cols);
    const int v0 = clamp(std::ceil(p.row(1).minCoeff()), grey.rows),
              v1 = clamp(std::floor(p.row(1).maxCoeff()) + 1, grey.rows);
    for (int v = v0; v < v1; ++v) {
      for (int u = u0; u < u1; ++u) {
        const Eigen::Vector2d s = inverse * (Eigen::Vector2d(u, v) - p.col(0));
        const Eigen::Vector3d weights(1.0 - s.sum(), s.x(), s.y());
        if (weights.minCoeff() < -1e-9) continue;
        const auto z = static_cast<float>(weights[0] * local(2, nodes[0]) + weights[1] * local(2, nodes[1]) +
                                          weights[2] * local(2, nodes[2]));
        if (z >= depth.at<float>(v, u)) continue;
        depth.at<float>(v, u) = z;
        double value = weights[0] * shade[nodes[0]] + weights[1] * shade[nodes[1]] + weights[2] * shade[nodes[2]];
        if (scene_.fine) value += kTexture * texture_.at(rest * weights);
        grey.at<float>(v, u) = static_cast<float>(value);
      }
    }
  }

  const TetMesh& mesh_;
  ImageScene scene_;
  std::uint64_t seed_;
  SurfaceTriangles triangles_;
  Texture texture_;
  Eigen::VectorXd at_nodes_;  ///< the texture at the nodes, 0 if it is finer
  cv::Mat background_;
};

}  // namespace

std::unique_ptr<Renderer> make_camera_renderer(const Model& model, const ImageScene& scene, std::uint64_t seed) {
  return std::make_unique<CameraRenderer>(model, scene, seed);
}

}  // namespace tissue_stiffness
