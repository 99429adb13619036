#pragma once

#include <cstddef>
#include <opencv2/core/mat.hpp>
#include <opencv2/videoio.hpp>
#include <string>

namespace tissue_stiffness {

/// A film that OpenCV decodes: a file such as film.mp4, or images such as frames_%04d.png, numbered from 0.
class Film {
 public:
  /// Throws InputError for a file that OpenCV does not decode.
  explicit Film(const std::string& file);

  /// Returns the number of frames. All of them are decoded for it, because what a file says of itself may be wrong.
  std::size_t count() const;
  /// Returns frames a second as the file has it; 0: it does not say. Images never do.
  double rate() const;
  /// Returns width and height [pixel].
  cv::Size size() const;
  /// Returns the next frame, in 8-bit blue, green and red. Throws InputError where there is none.
  cv::Mat next();

 private:
  std::string file_;
  cv::VideoCapture capture_;
};

}  // namespace tissue_stiffness
