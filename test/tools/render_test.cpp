#include "tools/render.hpp"

#include <opencv2/imgproc.hpp>

#include "tissue_stiffness/meshing/build_mesh.hpp"
#include "tools/scene.hpp"
#include "workbench.hpp"

namespace tissue_stiffness {
namespace {

class RenderTest : public Workbench {
 protected:
  Scene scene(const std::string& observation, const std::string& sensor) const {
    return load_scene(write_model("scene.yaml", "4e5", observation,
                                  "simulation: {duration: 1, rate: 10, step: 0.01, sensors: {/image: " + sensor + "}}\n"));
  }
};

TEST_F(RenderTest, DrawsTheSilhouetteWhereThePinholeSeesIt) {
  Scene scene = this->scene("- contour: {image: /image, camera_info: /info, noise: 3e-4}\n",
                            "{focal_length: 4000, position: [0.05, -1, 0.01], target: [0.05, 0, 0.01], noise: 0, blur: 0}");
  const Model model(scene.model, build_mesh(scene.model.mesh));
  const Camera& camera = scene.sensors[0].image->camera;
  const cv::Mat image = make_camera_renderer(model, *scene.sensors[0].image, 1)->draw(model.mesh().nodes, 0);
  const Eigen::Vector2d low = camera.project({0, 0, 0}), high = camera.project({0.1, 0, 0.02});  // the near face
  const auto grey = [&](double u, double v) {
    return static_cast<int>(image.at<uchar>(static_cast<int>(std::lround(v)), static_cast<int>(std::lround(u))));
  };
  for (double u = low.x() + 3; u < high.x() - 3; u += 7) {
    EXPECT_LT(grey(u, low.y() + 2) + 15, grey(u, low.y() - 2)) << u;  // v is down
    EXPECT_LT(grey(u, high.y() - 2) + 15, grey(u, high.y() + 2)) << u;
  }
}

TEST_F(RenderTest, DrawsTheCutOfTheWallInTheSector) {
  Scene scene = this->scene(
      "- contour: {image: /image, camera_info: /info, noise: 3e-4, projection: slice}\n",
      "{pixels_per_metre: 3000, apex: [0.05, 0.01, -0.05], axis: [0, 0, 1], lateral: [1, 0, 0], sector: 90, depth: 0.14}");
  const Model model(scene.model, build_mesh(scene.model.mesh));
  const ImageScene& echo = *scene.sensors[0].image;
  const cv::Mat image = make_echo_renderer(model, scene.model.observations[0], echo, 1)->draw(model.mesh().nodes, 0);
  const auto mean = [&](const Eigen::Vector3d& centre) {
    const Eigen::Vector2d p = echo.camera.project(centre);
    return cv::mean(image(cv::Rect(static_cast<int>(p.x()) - 10, static_cast<int>(p.y()) - 10, 21, 21)))[0];
  };
  EXPECT_GT(mean({0.05, 0.01, 0.01}), 100.0);  // inside the bar
  EXPECT_LT(mean({0.05, 0.01, 0.05}), 70.0);   // behind it
  EXPECT_EQ(image.at<uchar>(5, 5), 0);         // outside the sector
}

TEST_F(RenderTest, RepeatsItself) {
  Scene scene = this->scene("- contour: {image: /image, camera_info: /info, noise: 3e-4}\n",
                            "{focal_length: 4000, position: [0.05, -1, 0.01], target: [0.05, 0, 0.01]}");
  const Model model(scene.model, build_mesh(scene.model.mesh));
  const auto draw = [&](int frame) {
    return make_camera_renderer(model, *scene.sensors[0].image, 1)->draw(model.mesh().nodes, frame);
  };
  EXPECT_EQ(cv::norm(draw(4), draw(4), cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(draw(4), draw(5), cv::NORM_INF), 0.0);
}

}  // namespace
}  // namespace tissue_stiffness
