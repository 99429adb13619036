#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <optional>

namespace tissue_stiffness {

/// The part of a reference image around a feature, and where it is in other images.
class TextureWindow {
 public:
  static constexpr int half = 15, edge = 2 * half + 1;  ///< [pixel]

  struct Place {
    cv::Point2f centre;  ///< [pixel]
    double sigma;        ///< of each coordinate [pixel]
  };

  /// `smooth`: see smooth_image. The window around `centre` has to lie in it.
  TextureWindow(const cv::Mat& smooth, const cv::Point& centre);

  /// Returns the standard deviation to which the window's place is known by least squares, if both images had white noise
  /// of this standard deviation before they were smoothed. The unknowns are its place, its linear deformation, and the
  /// brightness and contrast. With the tangents J of its pixels and the filter K,
  ///   C = 2 noise^2 (J^T J)^-1 J^T K K^T J (J^T J)^-1.
  /// The gradients of the noise are no information. It is infinite for a window without texture.
  double sigma(double noise) const;

  /// Finds how the window is shifted and deformed in an image, near `there`, by the enhanced correlation coefficient
  /// (Evangelidis & Psarakis 2008, IEEE Trans. PAMI 30(10)), which changes of brightness and contrast leave alone. It
  /// starts from the deformation that was found last. Returns nothing where the window is not alike.
  std::optional<Place> find(const cv::Mat& smooth, const cv::Point2f& there);

 private:
  using Matrix = cv::Matx<double, 8, 8>;

  cv::Mat window_;
  Matrix information_;  ///< J^T J
  Matrix noise_;        ///< J^T K K^T J
  cv::Matx22f deformation_;
  double contrast_;  ///< standard deviation of the window's grey values
};

/// Returns a CV_8UC1 image as CV_32FC1, smoothed.
cv::Mat smooth_image(const cv::Mat& grey);

/// Returns the standard deviation of an image's noise, by differences that smooth images do not show (Immerkaer 1996,
/// Comput. Vis. Image Underst. 64(2)).
double image_noise(const cv::Mat& grey);

}  // namespace tissue_stiffness
