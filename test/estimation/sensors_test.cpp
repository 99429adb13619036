// Every kind of sensor finds the modulus on a small scene, and incomplete models are refused.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "bar.hpp"
#include "observation/closest_point.hpp"
#include "observation/observation_operator.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kTruth = 30e3;

class Sensors : public testing::Test {
 protected:
  void watch(const std::string& observations) {
    settings_ = box_settings(bar_under_gravity(prior(60e3, 3)), observations);
    bar_ = std::make_unique<Experiment>(settings_, mesh_, std::vector<double>{kTruth});
    sensor_ = std::move(make_observation_operators(bar_->model()).front());
    moments_ = bar_->film(0.0, kFilmed, 25);
  }
  void expect_found(const std::string& what, const std::vector<Frame>& frames) {
    Estimator estimator(settings_, mesh_);
    const StepResult last = step_through(estimator, frames);
    const ParameterEstimate& p = last.estimate.parameters.front();
    std::printf("%s: E = %.0f Pa, truth %.0f, 95 %% %.0f..%.0f, %d rows a frame\n", what.c_str(), p.mean, kTruth, p.lower95,
                p.upper95, last.misfit.count);
    EXPECT_TRUE(last.used) << last.reason;
    EXPECT_LT(std::abs(p.mean - kTruth), 3.0 * p.std);
    const VarianceShares& from = last.estimate.variance.front();
    EXPECT_LT(p.std / p.mean, 0.05) << last.estimate.state_reason << "; from noise " << from.noise << ", model "
                                    << from.model;
    EXPECT_NEAR(last.misfit.rms_sigma, 1.0, 0.35);
  }
  Eigen::Matrix3Xd positions(const Experiment::Moment& moment) const {
    return mesh_.nodes + Eigen::Map<const Eigen::Matrix3Xd>(moment.displacement.data(), 3, mesh_.node_count());
  }

  TetMesh mesh_ = bar_mesh();
  ModelSettings settings_;
  std::unique_ptr<Experiment> bar_;
  std::unique_ptr<ObservationOperator> sensor_;
  std::vector<Experiment::Moment> moments_;
  std::mt19937 engine_{11};
};

TEST_F(Sensors, MarkersThatStandOffTheSurface) {
  watch(
      "[{markers: {topic: /markers, noise: 2.0e-4, rest: [[0.09, 0.01, 0.025], [0.06, -0.004, 0.01], [0.1, 0.02, 0.02], "
      "[0.03, 0.024, 0.012]]}}]");
  std::vector<Frame> frames;
  for (const auto& moment : moments_) {
    Observation seen;
    seen.kind = ObservationKind::markers;
    seen.ids = Eigen::Vector4i(0, 3, 1, 2);
    seen.points = Eigen::Matrix3Xd::Zero(3, 4);
    const Eigen::VectorXd exact = sensor_->predict(seen, moment.displacement).predicted;
    seen.points = Eigen::Map<const Eigen::Matrix3Xd>(exact.data(), 3, 4) + draw(4, 2e-4, engine_);
    frames.push_back({moment.time, {seen}});
  }
  expect_found("markers", frames);
}

TEST_F(Sensors, PointsWithoutIdentity) {
  watch("[{points: {topic: /points, noise: 2.0e-4}}]");
  const SurfaceTriangles surface = split_facets(mesh_);
  std::uniform_int_distribution<Eigen::Index> any(0, surface.nodes.cols() - 1);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<Frame> frames;
  for (const auto& moment : moments_) {
    const Eigen::Matrix3Xd x = positions(moment);
    Observation seen;
    seen.kind = ObservationKind::points;
    seen.points = draw(60, 2e-4, engine_);
    for (Eigen::Index i = 0; i < seen.points.cols(); ++i) {
      const Eigen::Vector3i corners = surface.nodes.col(any(engine_));
      double a = unit(engine_), b = unit(engine_);
      if (a + b > 1.0) a = 1.0 - a, b = 1.0 - b;
      seen.points.col(i) += (1.0 - a - b) * x.col(corners[0]) + a * x.col(corners[1]) + b * x.col(corners[2]);
    }
    frames.push_back({moment.time, {seen}});
  }
  expect_found("points", frames);
}

// Returns the model's own outline: a point in the middle of each piece, shifted by noise along its normal.
std::vector<Frame> outlines(const ObservationOperator& sensor, const std::vector<Experiment::Moment>& moments,
                            const std::shared_ptr<const Camera>& camera, double sigma, std::mt19937& engine) {
  std::normal_distribution<double> noise(0.0, sigma);
  std::vector<Frame> frames;
  for (const auto& moment : moments) {
    Observation seen;
    seen.kind = ObservationKind::contour;
    seen.camera = camera;
    const Eigen::Matrix4Xd pieces = sensor.outline(seen, moment.displacement);
    const Eigen::Vector2d middle = 0.5 * (pieces.topRows<2>() + pieces.bottomRows<2>()).rowwise().mean();
    auto contour = std::make_shared<Contour>();
    contour->points.resize(2, pieces.cols());
    contour->normals.resize(2, pieces.cols());
    contour->sigma = Eigen::VectorXd::Constant(pieces.cols(), sigma);
    for (Eigen::Index i = 0; i < pieces.cols(); ++i) {
      const Eigen::Vector2d from = pieces.col(i).head<2>(), along = pieces.col(i).tail<2>() - from,
                            centre = from + 0.5 * along;
      Eigen::Vector2d normal = Eigen::Vector2d(along.y(), -along.x()).normalized();
      if (normal.dot(centre - middle) < 0.0) normal = -normal;
      contour->points.col(i) = centre + noise(engine) * normal;
      contour->normals.col(i) = normal;
    }
    seen.contour = contour;
    frames.push_back({moment.time, {seen}});
  }
  return frames;
}

std::shared_ptr<Camera> camera(const Eigen::Matrix3d& axes, const Eigen::Vector3d& at) {
  auto out = std::make_shared<Camera>();
  out->width = out->height = 640;
  out->cx = out->cy = 320.0;
  out->model_from_sensor = Eigen::Isometry3d::Identity();
  out->model_from_sensor.linear() = axes;
  out->model_from_sensor.translation() = at;
  return out;
}

TEST_F(Sensors, TheSilhouetteInACamera) {
  watch("[{contour: {image: /image, camera_info: /info, noise: 1.0e-5, projection: silhouette}}]");
  Eigen::Matrix3d axes;  // looks along y, half a metre before the bar, z up
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  const auto pinhole = camera(axes, {0.05, -0.5, 0.01});
  pinhole->fx = pinhole->fy = 1000.0;
  expect_found("silhouette", outlines(*sensor_, moments_, pinhole, 0.3, engine_));
}

TEST_F(Sensors, TheSliceInAnUltrasoundImage) {
  watch("[{contour: {image: /image, camera_info: /info, noise: 1.0e-5, projection: slice}}]");
  Eigen::Matrix3d axes;  // image plane x-z, lengthwise through the bar
  axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  const auto slice = camera(axes, {0, 0.0093, 0});
  slice->projection = Camera::Projection::slice;
  slice->fx = slice->fy = 4000.0;
  expect_found("slice", outlines(*sensor_, moments_, slice, 0.8, engine_));
}

TEST(Models, WithoutUnknownsOrSensorsAreRefused) {
  EXPECT_NE(refusal([] { Estimator(box_settings(bar_under_gravity("3.0e4")), bar_mesh()); }).find("{prior, factor}"),
            std::string::npos);
  EXPECT_NE(refusal([] {
              Estimator(box_settings(bar_under_gravity(prior(3e4, 2)), "[{points: {topic: /p, noise: 1.0e-4}}]",
                                     "estimator: paper"),
                        bar_mesh());
            }).find("vertices only"),
            std::string::npos);
}

}  // namespace
}  // namespace tissue_stiffness
