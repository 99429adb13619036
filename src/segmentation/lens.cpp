#include "segmentation/lens.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include "segmentation/outline.hpp"
#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

using Lens = Camera::Lens;

constexpr int kIterations = 100;
constexpr double kCloseEnough = 0.02;  // [pixel] between a point and where the lens puts its undistorted place
constexpr double kReach = 0.5;         // [pixel] over which a normal is followed through the lens

struct LensModel {
  const char* name;
  Lens lens;
  std::vector<std::size_t> counts;  ///< of coefficients
  const char* coefficients;
};

const std::array<LensModel, 3>& lens_models() {
  static const std::array<LensModel, 3> models{
      {{"plumb_bob", Lens::plumb_bob, {4, 5}, "k1 k2 p1 p2 and k3"},
       {"rational_polynomial", Lens::rational_polynomial, {8}, "k1 k2 p1 p2 k3 k4 k5 k6"},
       {"equidistant", Lens::equidistant, {4}, "k1 k2 k3 k4"}}};
  return models;
}

cv::Matx33d matrix_of(const Camera& camera) {
  return {camera.fx, 0.0, camera.cx, 0.0, camera.fy, camera.cy, 0.0, 0.0, 1.0};
}

cv::Mat coefficients_of(const Camera& camera) {
  cv::Mat out;
  cv::eigen2cv(camera.distortion, out);
  return out;
}

std::vector<cv::Point2d> to_points(const Eigen::Matrix2Xd& points) {
  std::vector<cv::Point2d> out;
  for (Eigen::Index i = 0; i < points.cols(); ++i) out.emplace_back(points(0, i), points(1, i));
  return out;
}

}  // namespace

void set_lens(const std::string& model, const std::vector<double>& coefficients, const std::string& where, Camera* camera) {
  if (coefficients.empty()) return;
  const auto& models = lens_models();
  const auto found = std::find_if(models.begin(), models.end(), [&](const LensModel& m) { return m.name == model; });
  if (found == models.end()) {
    throw InputError(where + ": distortion_model", "'" + model + "'",
                     "plumb_bob, rational_polynomial, equidistant, or an empty D");
  }
  if (std::count(found->counts.begin(), found->counts.end(), coefficients.size()) == 0) {
    throw InputError(where + ": D", std::to_string(coefficients.size()) + " numbers",
                     std::string(found->coefficients) + " of " + model + ", or an empty D");
  }
  for (const double value : coefficients) {
    if (!std::isfinite(value)) throw InputError(where + ": D", std::to_string(value), "finite numbers");
  }
  if (std::all_of(coefficients.begin(), coefficients.end(), [](double value) { return value == 0.0; }) &&
      found->lens != Lens::equidistant) {  // which moves points without any coefficient
    return;
  }
  if (camera->projection == Camera::Projection::slice) {
    throw InputError(where + ": D", "a distortion of '" + model + "'", "an empty D: a slice has no lens");
  }
  camera->lens = found->lens;
  camera->distortion =
      Eigen::Map<const Eigen::VectorXd>(coefficients.data(), static_cast<Eigen::Index>(coefficients.size()));
}

std::string lens_name(Lens lens) {
  for (const LensModel& model : lens_models()) {
    if (model.lens == lens) return model.name;
  }
  return lens_models().front().name;
}

Eigen::Matrix2Xd distort(const Camera& camera, const Eigen::Matrix2Xd& points) {
  if (camera.lens == Lens::none || points.cols() == 0) return points;
  std::vector<cv::Point2d> moved;
  if (camera.lens == Lens::equidistant) {
    const Eigen::Array2d focal(camera.fx, camera.fy), centre(camera.cx, camera.cy);
    const Eigen::Matrix2Xd plane = ((points.array().colwise() - centre).colwise() / focal).matrix();
    cv::fisheye::distortPoints(to_points(plane), moved, matrix_of(camera), coefficients_of(camera));
  } else {
    std::vector<cv::Point3d> rays;
    for (Eigen::Index i = 0; i < points.cols(); ++i) {
      rays.emplace_back((points(0, i) - camera.cx) / camera.fx, (points(1, i) - camera.cy) / camera.fy, 1.0);
    }
    cv::projectPoints(rays, cv::Vec3d::all(0.0), cv::Vec3d::all(0.0), matrix_of(camera), coefficients_of(camera), moved);
  }
  return to_matrix(moved);
}

Eigen::Matrix2Xd undistort(const Camera& camera, const Eigen::Matrix2Xd& points) {
  if (camera.lens == Lens::none || points.cols() == 0) return points;
  std::vector<cv::Point2d> moved;
  const cv::Matx33d matrix = matrix_of(camera);
  if (camera.lens == Lens::equidistant) {
    cv::fisheye::undistortPoints(to_points(points), moved, matrix, coefficients_of(camera), cv::noArray(), matrix);
  } else {
    const cv::TermCriteria until(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kIterations, 1e-9);
    cv::undistortPoints(to_points(points), moved, matrix, coefficients_of(camera), cv::noArray(), matrix, until);
  }
  Eigen::Matrix2Xd out = to_matrix(moved);
  const Eigen::Matrix2Xd again = distort(camera, out);  // the search does not say whether it has found the place
  for (Eigen::Index i = 0; i < out.cols(); ++i) {
    if (!((again.col(i) - points.col(i)).norm() < kCloseEnough))
      out.col(i).setConstant(std::numeric_limits<double>::quiet_NaN());
  }
  return out;
}

void undistort(const Camera& camera, Contour* contour) {
  if (camera.lens == Lens::none || contour->empty()) return;
  const Eigen::Index n = contour->size();
  Eigen::Matrix2Xd tangents(2, n);
  tangents << -contour->normals.row(1), contour->normals.row(0);
  Eigen::Matrix2Xd all(2, 3 * n);
  all << contour->points, contour->points + kReach * contour->normals, contour->points + kReach * tangents;
  const Eigen::Matrix2Xd moved = undistort(camera, all);
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d place = moved.col(i);
    const Eigen::Vector2d along = moved.col(n + i) - place, tangent = moved.col(2 * n + i) - place;
    if (!place.allFinite() || !along.allFinite() || !tangent.allFinite()) {
      contour->sigma(i) = std::numeric_limits<double>::infinity();
      continue;
    }
    Eigen::Vector2d normal = Eigen::Vector2d(tangent.y(), -tangent.x()).normalized();
    if (normal.dot(along) < 0.0) normal = -normal;
    contour->points.col(i) = place;
    contour->normals.col(i) = normal;
    contour->sigma(i) *= normal.dot(along) / kReach;
  }
}

void undistort(const Camera& camera, FeatureTracks* tracks) {
  tracks->pixels = undistort(camera, tracks->pixels);
  tracks->reference = undistort(camera, tracks->reference);
}

cv::Mat undistort(const Camera& camera, const cv::Mat& image) {
  if (camera.lens == Lens::none) return image;
  cv::Mat out;
  if (camera.lens == Lens::equidistant) {
    cv::fisheye::undistortImage(image, out, matrix_of(camera), coefficients_of(camera), matrix_of(camera));
  } else {
    cv::undistort(image, out, matrix_of(camera), coefficients_of(camera));
  }
  return out;
}

}  // namespace tissue_stiffness
