#include <cmath>
#include <random>

#include "mesh_checks.hpp"
#include "meshing/bodies.hpp"
#include "meshing/quality.hpp"
#include "meshing/revolution_profile.hpp"
#include "meshing/tetgen_mesher.hpp"
#include "tissue_stiffness/meshing/build_mesh.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kFocal = 2500.0, kDistance = 1.0, kRadius = 0.03;

// Looks along +y at the model's origin, z up in the image.
Camera side_camera() {
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = kFocal;
  camera.cx = 319.5;
  camera.cy = 239.5;
  Eigen::Matrix3d axes;
  axes << 1, 0, 0, 0, 0, 1, 0, -1, 0;
  camera.model_from_sensor.linear() = axes;
  camera.model_from_sensor.translation() = Eigen::Vector3d(0, -kDistance, 0);
  return camera;
}

Contour with_normals(Contour contour, double noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const Eigen::Index n = contour.size();
  const Eigen::Matrix2Xd exact = contour.points;
  contour.width = 640;
  contour.height = 480;
  contour.normals.resize(2, n);
  contour.sigma = Eigen::VectorXd::Constant(n, std::max(noise, 0.05));
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Vector2d along = exact.col((i + 1) % n) - exact.col((i + n - 1) % n);
    contour.normals.col(i) = Eigen::Vector2d(along.y(), -along.x()).normalized();
    contour.points.col(i) += noise * normal(random) * contour.normals.col(i);
  }
  return contour;
}

// Silhouette of a sphere: the cone of half angle asin(R / D) about the direction of its centre.
Contour sphere_contour(const Camera& camera, const Eigen::Vector3d& centre, double noise, unsigned seed = 1) {
  const Eigen::Vector3d seen = camera.model_from_sensor.inverse() * centre;
  const Eigen::Vector3d view = seen.normalized(), u = view.unitOrthogonal(), v = view.cross(u);
  const double angle = std::asin(kRadius / seen.norm());
  Contour contour;
  contour.points.resize(2, 400);
  for (int i = 0; i < 400; ++i) {
    const double turn = 2.0 * M_PI * i / 400;
    const Eigen::Vector3d d = std::cos(angle) * view + std::sin(angle) * (std::cos(turn) * u + std::sin(turn) * v);
    contour.points.col(i) = kFocal * d.head<2>() / d.z() + Eigen::Vector2d(camera.cx, camera.cy);
  }
  return with_normals(contour, noise, seed);
}

double worst_radius_error(const RevolutionProfile& profile, const Eigen::Vector3d& centre) {
  double worst = 0.0;
  for (int i = 0; i <= 180; ++i) {
    const Eigen::Vector2d at = profile.meridian(M_PI * i / 180.0);
    const Eigen::Vector3d x = profile.centre() + at.y() * profile.axis() + at.x() * profile.axis().unitOrthogonal();
    worst = std::max(worst, std::abs((x - centre).norm() - kRadius));
  }
  return worst;
}

TEST(FitProfile, RemovesPerspectiveFromASphere) {
  const Camera camera = side_camera();
  for (const Eigen::Vector3d& centre : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.01, 0, 0.02)}) {
    const Contour contour = sphere_contour(camera, centre, 0.0);
    const ProfileFit fit = fit_profile(viewing_rays(contour, camera), camera, Eigen::Vector3d::UnitZ());
    EXPECT_LT(worst_radius_error(fit.profile, centre), 1e-9 * kRadius);
  }
}

TEST(FitProfile, SmoothsSubPixelNoise) {
  const Camera camera = side_camera();
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Contour contour = sphere_contour(camera, {0, 0, 0}, 0.1, seed);
    const ProfileFit fit = fit_profile(viewing_rays(contour, camera), camera, Eigen::Vector3d::UnitZ());
    EXPECT_LT(worst_radius_error(fit.profile, {0, 0, 0}), 1.5e-3 * kRadius);
    EXPECT_NEAR(fit.profile.coefficients()[0], kRadius, 3e-4 * kRadius);
    EXPECT_NEAR(fit.rms, 0.1 * kDistance / kFocal, 0.2 * 0.1 * kDistance / kFocal);
  }
}

TEST(FitProfile, TurnsWithTheAxis) {
  const Camera camera = side_camera();
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 0.3, 1).normalized();
  const Contour contour = sphere_contour(camera, {0, 0, 0}, 0.0);
  const ProfileFit fit = fit_profile(viewing_rays(contour, camera), camera, axis);
  EXPECT_LT(worst_radius_error(fit.profile, {0, 0, 0}), 1e-7 * kRadius);
}

// An egg, whose silhouette is found by brute force: the extreme of its points in every direction of the image.
TEST(FitProfile, FindsABodyThatIsNotASphere) {
  const Camera camera = side_camera();
  Eigen::VectorXd truth(4);
  truth << 0.03, 0.0, 0.004, 0.001;
  const RevolutionProfile egg(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), truth);
  Contour contour;
  contour.points = Eigen::Matrix2Xd::Zero(2, 720);
  Eigen::VectorXd farthest = Eigen::VectorXd::Zero(720);
  const Eigen::Vector2d middle(camera.cx, camera.cy);
  for (int i = 1; i < 4000; ++i) {
    const Eigen::Vector2d at = egg.meridian(M_PI * i / 4000);
    for (int k = -600; k <= 600; ++k) {  // generators lie near the plane that faces the camera
      const double turn = 0.1 * k / 600;
      for (const double side : {-1.0, 1.0}) {
        const Eigen::Vector2d p =
            camera.project({side * at.x() * std::cos(turn), -at.x() * std::sin(turn), at.y()}) - middle;
        const auto bin = static_cast<int>((std::atan2(p.y(), p.x()) + M_PI) / (2.0 * M_PI) * 720) % 720;
        if (p.norm() <= farthest[bin]) continue;
        farthest[bin] = p.norm();
        contour.points.col(bin) = p + middle;
      }
    }
  }
  const Contour seen = with_normals(contour, 0.0, 1);
  const ProfileFit fit = fit_profile(viewing_rays(seen, camera), camera, Eigen::Vector3d::UnitZ());
  for (int i = 0; i <= 18; ++i) {
    const double angle = M_PI * i / 18.0;
    const Eigen::Vector2d at = egg.meridian(angle);
    EXPECT_NEAR(fit.profile.distance({at.x(), 0.0, at.y()}), 0.0, 1e-3 * kRadius) << "at " << angle << " rad";
  }
}

TEST(RevolutionSurface, HasNearlyEquilateralTriangles) {
  const RevolutionProfile sphere(Eigen::Vector3d::Zero(), Eigen::Vector3d(1, 2, 3), Eigen::VectorXd::Constant(1, kRadius));
  for (const double edge : {0.0075, 0.003}) {
    const TriangleSurface surface = revolution_surface(sphere, edge);
    check_watertight(surface, "sphere");
    double shortest = 1.0, longest = 0.0;
    for (int t = 0; t < surface.triangle_count(); ++t) {
      EXPECT_GT(triangle_area_vector(surface, t).dot(surface.vertices.col(surface.triangles(0, t))), 0.0);
      for (int i = 0; i < 3; ++i) {
        const double length =
            (surface.vertices.col(surface.triangles(i, t)) - surface.vertices.col(surface.triangles((i + 1) % 3, t)))
                .norm();
        shortest = std::min(shortest, length);
        longest = std::max(longest, length);
      }
    }
    EXPECT_GT(shortest, 0.6 * edge);
    EXPECT_LT(longest, 1.7 * edge);
  }
}

MeshSettings contour_settings(MeshSettings::Source source, double edge) {
  MeshSettings settings;
  settings.source = source;
  settings.max_edge_length = edge;
  settings.depth = 0.02;
  return settings;
}

TEST(RevolvedMesh, IsACurvedBall) {
  if (!has_tetgen()) GTEST_SKIP() << "this build is without TetGen";
  const Camera camera = side_camera();
  MeshSettings settings = contour_settings(MeshSettings::Source::revolve, 0.0075);
  const TetMesh mesh = build_mesh(settings, sphere_contour(camera, {0, 0, 0}, 0.0), camera);
  const double volume = 4.0 / 3.0 * M_PI * std::pow(kRadius, 3);
  expect_sound(mesh, volume, 0.03 * volume);
  for (int f = 0; f < mesh.facet_count(); ++f) {
    for (int i = 0; i < 6; ++i) EXPECT_NEAR(mesh.nodes.col(mesh.facets(i, f)).norm(), kRadius, 1e-3 * kRadius);
  }
  const MeshQuality quality = measure_quality(mesh);
  EXPECT_GT(quality.least_jacobian_ratio, 0.3);
  EXPECT_GT(quality.least_radius_ratio, 0.1);
  EXPECT_NEAR(quality.mean_edge_length, 0.0075, 0.2 * 0.0075);
  settings.order = 1;
  EXPECT_EQ(build_mesh(settings, sphere_contour(camera, {0, 0, 0}, 0.0), camera).tets.rows(), 4);
}

// Front face of a block of 0.08 x 0.03 x 0.02 m, which hides the rest of it.
Contour block_contour(const Camera& camera, double noise) {
  const double scale = kFocal / (kDistance - 0.01);
  const Eigen::Vector2d half(0.04 * scale, 0.015 * scale), middle(camera.cx, camera.cy);
  std::vector<Eigen::Vector2d> points;
  const Eigen::Vector2d corners[] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector2d at = corners[side] + (corners[side + 1] - corners[side]) * i / 50.0;
      points.push_back(at.cwiseProduct(half) + middle);
    }
  }
  Contour contour;
  contour.points.resize(2, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) contour.points.col(static_cast<Eigen::Index>(i)) = points[i];
  return with_normals(contour, noise, 3);
}

TEST(ExtrudedMesh, IsTheBlock) {
  if (!has_tetgen()) GTEST_SKIP() << "this build is without TetGen";
  const Camera camera = side_camera();
  for (const double noise : {0.0, 0.2}) {
    const TetMesh mesh =
        build_mesh(contour_settings(MeshSettings::Source::extrude, 0.008), block_contour(camera, noise), camera);
    expect_sound(mesh, 0.08 * 0.03 * 0.02, (noise > 0.0 ? 2e-3 : 1e-9) * 0.08 * 0.03 * 0.02);
    const Eigen::Vector3d half(0.04, 0.01, 0.015);
    EXPECT_LT((mesh.nodes.rowwise().maxCoeff() - half).norm(), noise > 0.0 ? 2e-4 : 1e-9);
    EXPECT_LT((mesh.nodes.rowwise().minCoeff() + half).norm(), noise > 0.0 ? 2e-4 : 1e-9);
  }
}

TEST(ContourMesh, RefusesBadOutlines) {
  const Camera camera = side_camera();
  const MeshSettings settings = contour_settings(MeshSettings::Source::revolve, 0.0075);
  const Contour good = sphere_contour(camera, {0, 0, 0}, 0.0);
  const auto message = [&](const MeshSettings& with, const Contour& contour) {
    return refusal([&] { build_mesh(with, contour, camera); });
  };
  Contour bad = good;
  bad.closed = false;
  expect_contains(message(settings, bad), "an open outline");
  bad = good;
  bad.sigma.tail(bad.size() - 5).setConstant(std::numeric_limits<double>::infinity());
  expect_contains(message(settings, bad), "5 points whose edge was seen");
  bad = good;
  bad.points.col(100).swap(bad.points.col(300));
  expect_contains(message(settings, bad), "crosses itself at pixel (");
  bad = good;
  bad.points(0, 3) = std::nan("");
  expect_contains(message(settings, bad), "point 3");
  MeshSettings along = settings;
  along.axis = Eigen::Vector3d::UnitY();
  expect_contains(message(along, good), "mesh.revolve.axis");
  MeshSettings unsized = settings;
  unsized.max_edge_length = 0.0;
  expect_contains(message(unsized, good), "mesh.max_edge_length");
  MeshSettings deep = contour_settings(MeshSettings::Source::extrude, 0.0075);
  deep.depth = 3.0;
  expect_contains(message(deep, good), "behind the camera");
  Contour sheared = good;  // not symmetric about the axis
  sheared.points.row(0) += 0.8 * (good.points.row(1).array() - camera.cy).matrix();
  expect_contains(message(settings, sheared), "no body of revolution about mesh.revolve.axis");
}

}  // namespace
}  // namespace tissue_stiffness
