// Counts right, wrong and refused outlines in drawn films of a laboratory: a purple beam swings before a grey wall with a
// bright window, and films 2 to 5 add a trouble each. Prints a table in Markdown.
#include <cmath>
#include <cstdio>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "segmentation/outline.hpp"
#include "segmentation/silhouette.hpp"

namespace ts = tissue_stiffness;

namespace {

constexpr int kFrames = 60, kWidth = 640, kHeight = 480, kSuper = 4;
constexpr double kPeriod = 15.0;       // frames
constexpr double kRight = 2.0;         // [pixel] 90 % of an outline's points are nearer to the truth
constexpr double kSmallestSeen = 0.5;  // of the true outline's length
const cv::Scalar kPurple(150, 48, 112), kSkin(150, 170, 215), kWall(135, 140, 138), kWindow(252, 250, 248),
    kDark(40, 42, 45);

enum class Trouble { none, light, hand, glove, person };
const std::vector<std::pair<Trouble, const char*>> kFilms{{Trouble::none, "calm"},
                                                          {Trouble::light, "light from 50 to 130 %"},
                                                          {Trouble::hand, "a hand crosses the beam"},
                                                          {Trouble::glove, "a purple glove beside it"},
                                                          {Trouble::person, "a dark coat behind it"}};

using Outline = std::vector<cv::Point2d>;

/// The beam's outline in frame k [pixel]: it is held on the left and bends like a cantilever.
Outline beam(int k) {
  const double swing = 60.0 * std::cos(2.0 * M_PI * k / kPeriod), half = 28.0, length = 300.0;
  Outline upper, lower;
  for (int i = 0; i <= 100; ++i) {
    const double s = i / 100.0, slope = swing / length * (2.0 * s) * 1.0;
    const cv::Point2d middle(150.0 + length * s, 270.0 + swing * s * s);
    const cv::Point2d normal = cv::Point2d(-slope, 1.0) / std::hypot(slope, 1.0);
    upper.push_back(middle - half * normal);
    lower.push_back(middle + half * normal);
  }
  upper.insert(upper.end(), lower.rbegin(), lower.rend());
  return upper;
}

void fill(cv::Mat& image, const Outline& outline, const cv::Scalar& colour) {
  std::vector<cv::Point> points;
  for (const cv::Point2d& p : outline) points.emplace_back(cvRound(kSuper * (p.x + 0.5)), cvRound(kSuper * (p.y + 0.5)));
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{points}, colour);
}

void box(cv::Mat& image, double u, double v, double width, double height, const cv::Scalar& colour) {
  fill(image, {{u, v}, {u + width, v}, {u + width, v + height}, {u, v + height}}, colour);
}

cv::Mat draw(Trouble trouble, int k) {
  cv::Mat large(kSuper * kHeight, kSuper * kWidth, CV_8UC3, kWall), image, values;
  box(large, 430, 20, 180, 130, kWindow);
  box(large, 515, 20, 8, 130, kDark);
  box(large, 0, 430, kWidth, 50, cv::Scalar(95, 105, 120));
  if (trouble == Trouble::person) box(large, 900 - 20 * k, 120, 160, 310, kDark);
  box(large, 90, 200, 60, 140, cv::Scalar(90, 90, 90));  // the clamp
  fill(large, beam(k), kPurple);
  if (trouble == Trouble::glove) box(large, 210, 90, 150, 90, kPurple);
  if (trouble == Trouble::hand && k >= 20 && k < 40) box(large, 250 + 6 * (k - 30), 60, 70, 260, kSkin);
  cv::resize(large, image, cv::Size(kWidth, kHeight), 0, 0, cv::INTER_AREA);
  image.convertTo(values, CV_32FC3);
  cv::GaussianBlur(values, values, {}, 0.9);
  const double light = trouble == Trouble::light ? 0.9 + 0.4 * std::cos(2.0 * M_PI * k / kFrames) : 1.0;
  for (int u = 0; u < kWidth; ++u) values.col(u) *= light * (1.1 - 0.25 * u / kWidth);
  cv::Mat noise(values.size(), CV_32FC3);
  cv::RNG random(1000U + static_cast<unsigned>(k));
  random.fill(noise, cv::RNG::NORMAL, 0.0, 4.0);
  values += noise;
  values.convertTo(image, CV_8U);
  std::vector<unsigned char> bytes;  // a webcam's compression, with colour at half the resolution
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 85});
  return cv::imdecode(bytes, cv::IMREAD_COLOR);
}

/// Whether the points whose edge was seen lie on the truth and are enough.
bool is_right(const ts::Contour& contour, const Outline& truth) {
  std::vector<cv::Point2f> polygon;
  for (const cv::Point2d& p : truth) polygon.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y));
  int seen = 0, near = 0;
  for (Eigen::Index i = 0; i < contour.size(); ++i) {
    if (!std::isfinite(contour.sigma(i))) continue;
    const cv::Point2f p(static_cast<float>(contour.points(0, i)), static_cast<float>(contour.points(1, i)));
    ++seen;
    near += std::abs(cv::pointPolygonTest(polygon, p, true)) < kRight;
  }
  const double spacing = ts::perimeter(contour.points) / static_cast<double>(contour.size());
  return near > 0.9 * seen && seen * spacing > kSmallestSeen * cv::arcLength(polygon, true);
}

struct Way {
  const char* name;
  std::unique_ptr<ts::Segmenter> segmenter;
};

std::vector<Way> ways() {
  ts::SegmentationSettings bright, roi, dark, colour, both;
  roi.roi = ts::PixelBox{60, 150, 440, 260};
  dark = roi;
  dark.body = ts::SegmentationSettings::Body::dark;
  colour.body = ts::SegmentationSettings::Body::colour;
  colour.colour = {112.0, 48.0, 150.0};
  colour.tolerance = 20.0;
  both = colour;
  both.roi = roi.roi;
  std::vector<Way> out;
  out.push_back({"bright, as before", std::make_unique<ts::SilhouetteSegmenter>(bright)});
  out.push_back({"bright", ts::make_segmenter(bright)});
  out.push_back({"bright, roi", ts::make_segmenter(roi)});
  out.push_back({"dark, roi", ts::make_segmenter(dark)});
  out.push_back({"colour", ts::make_segmenter(colour)});
  out.push_back({"colour, roi", ts::make_segmenter(both)});
  return out;
}

}  // namespace

int main() {
  std::puts("| film | body | right | wrong | refused |\n|---|---|---|---|---|");
  for (const auto& [trouble, film] : kFilms) {
    std::vector<cv::Mat> images;
    for (int k = 0; k < kFrames; ++k) images.push_back(draw(trouble, k));
    for (const Way& way : ways()) {
      int right = 0, wrong = 0;
      for (int k = 0; k < kFrames; ++k) {
        const ts::Segmentation found = way.segmenter->segment(images[static_cast<std::size_t>(k)], k / 30.0);
        if (!found.found()) continue;
        ++(is_right(found.contour, beam(k)) ? right : wrong);
      }
      const auto share = [](int count) { return 100.0 * count / kFrames; };
      std::printf("| %s | %s | %.0f %% | %.0f %% | %.0f %% |\n", film, way.name, share(right), share(wrong),
                  share(kFrames - right - wrong));
    }
  }
  return 0;
}
