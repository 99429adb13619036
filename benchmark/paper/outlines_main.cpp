// Prints the outlines that the package finds in a sequence of images: rows of image, u, v, sigma [pixel].
#include <cstdio>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "segmentation/overlay.hpp"
#include "tissue_stiffness/segmentation/segmenter.hpp"
#include "tools/run_tool.hpp"

namespace ts = tissue_stiffness;

namespace {

constexpr double kFrame = 1.0 / 30.0;  // s; any course of stamps does

struct Options {
  std::string kind, overlays;
  std::vector<double> seed;
  std::vector<std::string> images;
};

int print_outlines(const Options& options) {
  ts::SegmentationSettings settings;
  settings.kind =
      options.kind == "cavity" ? ts::SegmentationSettings::Kind::cavity : ts::SegmentationSettings::Kind::silhouette;
  if (!options.seed.empty()) settings.seed = Eigen::Vector2d(options.seed[0], options.seed[1]);
  const auto segmenter = ts::make_segmenter(settings);
  std::puts("image,u,v,sigma");
  for (std::size_t k = 0; k < options.images.size(); ++k) {
    const cv::Mat image = cv::imread(options.images[k], cv::IMREAD_GRAYSCALE);
    if (image.empty()) {
      std::fprintf(stderr, "outlines: %s is no readable image\n", options.images[k].c_str());
      return 2;
    }
    const ts::Segmentation found = segmenter->segment(image, kFrame * static_cast<double>(k));
    if (!found.found()) std::fprintf(stderr, "image %zu: %s\n", k, found.reason.c_str());
    for (Eigen::Index i = 0; i < found.contour.size(); ++i) {
      const Eigen::Vector2d p = found.contour.points.col(i);
      std::printf("%zu,%.4f,%.4f,%.4f\n", k, p.x(), p.y(), found.contour.sigma(i));
    }
    if (!options.overlays.empty()) {
      const cv::Mat drawn = ts::draw_overlay(image, found.contour, Eigen::Matrix2Xd(2, 0));
      cv::imwrite(options.overlays + "/" + std::to_string(k) + ".png", drawn);
    }
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  ts::CommandLine line("Outlines of a sequence of images, as CSV.", "outlines");
  line.add_positional("KIND", options.kind, "what is outlined").required().one_of({"silhouette", "cavity"});
  line.add_option("--seed", options.seed, "u v inside the body or the pool [pixel]").count(2, 2);
  line.add_option("--overlays", options.overlays, "folder for pictures with the outline");
  line.add_option("--images", options.images, "in their order").required();
  return ts::run_tool(line, argc, argv, [&] { return print_outlines(options); });
}
