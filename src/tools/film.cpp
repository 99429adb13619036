#include "tools/film.hpp"

#include <cmath>
#include <opencv2/core/utils/logger.hpp>

#include "tissue_stiffness/types/error.hpp"

namespace tissue_stiffness {
namespace {

bool numbered(const std::string& file) {
  return file.find('%') != std::string::npos;
}

// Each decoder that does not know a file says so, although another one may; and images end where one cannot be read.
class Silence {
 public:
  Silence() : level_(cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT)) {}
  ~Silence() { cv::utils::logging::setLogLevel(level_); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  cv::utils::logging::LogLevel level_;
};

cv::VideoCapture capture_of(const std::string& file) {
  const Silence silence;
  return cv::VideoCapture(file, numbered(file) ? cv::CAP_IMAGES : cv::CAP_ANY);
}

}  // namespace

Film::Film(const std::string& file) : file_(file), capture_(capture_of(file)) {
  if (!capture_.isOpened())
    throw InputError(file, "no film that OpenCV decodes", "a film, or images such as frames_%04d.png, numbered from 0");
}

std::size_t Film::count() const {
  cv::VideoCapture again = capture_of(file_);
  const Silence silence;
  std::size_t out = 0;
  while (again.grab()) ++out;
  return out;
}

double Film::rate() const {
  if (numbered(file_)) return 0.0;  // some decoders make one up
  const double rate = capture_.get(cv::CAP_PROP_FPS);
  return std::isfinite(rate) && rate > 0.0 ? rate : 0.0;
}

cv::Size Film::size() const {
  return {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
          static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
}

cv::Mat Film::next() {
  cv::Mat frame;
  if (!capture_.read(frame))
    throw InputError(file_, "no frame after those that were counted", "a film that can be decoded");
  return frame;
}

}  // namespace tissue_stiffness
