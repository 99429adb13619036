#include "tools/progress.hpp"

#include <unistd.h>

#include <algorithm>
#include <ostream>
#include <utility>

#include "types/formatted.hpp"

namespace tissue_stiffness {
namespace {

constexpr double kBarInterval = 0.1;  // [s]
constexpr double kLineInterval = 5.0;
constexpr std::size_t kBarWidth = 30;
constexpr std::size_t kTelling = 10;  // the part of all that must be done before its pace tells the rest's

}  // namespace

Progress::Progress(std::ostream& out, Style style, std::string what)
    : out_(out), style_(style), what_(std::move(what)), start_(std::chrono::steady_clock::now()) {}

Progress::Style Progress::style_of_stderr(bool quiet) {
  if (quiet) return Style::quiet;
  return isatty(STDERR_FILENO) != 0 ? Style::bar : Style::lines;
}

void Progress::show(std::size_t done, std::size_t total) {
  if (style_ == Style::quiet) return;
  const double elapsed = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const bool last = done == total && style_ == Style::bar;
  if (!last && elapsed - last_shown_ < (style_ == Style::bar ? kBarInterval : kLineInterval)) return;
  last_shown_ = elapsed;
  draw(done, total, elapsed);
}

void Progress::draw(std::size_t done, std::size_t total, double elapsed) {
  const double rate = elapsed > 0.0 ? static_cast<double>(done) / elapsed : 0.0;
  const double left = rate > 0.0 ? static_cast<double>(total - std::min(done, total)) / rate : 0.0;
  const std::string numbers = formatted("%zu/%zu, %.3g/s, %.0f s left", done, total, rate, left);
  if (style_ == Style::lines) {
    out_ << what_ << ": " << numbers << std::endl;
    return;
  }
  const std::size_t filled = total > 0 ? std::min(kBarWidth, kBarWidth * done / total) : kBarWidth;
  out_ << "\r" << what_ << " [" << std::string(filled, '#') << std::string(kBarWidth - filled, ' ') << "] " << numbers
       << "\033[K" << std::flush;
  drawn_ = true;
}

void Progress::finish() {
  if (drawn_) out_ << std::endl;
  drawn_ = false;
}

StepProgress::StepProgress(std::ostream& out, Progress::Style style, std::string what, Clock clock)
    : out_(out), style_(style), what_(std::move(what)), clock_(std::move(clock)), start_(clock_()) {}

double StepProgress::steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void StepProgress::show(const std::string& step, std::size_t done, std::size_t total) {
  if (style_ == Progress::Style::quiet) return;
  const double elapsed = clock_() - start_;
  const bool goes_on = step == last_step_ && done > 0;
  if (goes_on && elapsed - last_shown_ < (style_ == Progress::Style::bar ? kBarInterval : kLineInterval)) return;
  last_shown_ = elapsed;
  last_step_ = step;
  if (done == 0) counted_since_ = elapsed;
  if (!goes_on) ++steps_;
  const std::string head = formatted("%s [step %d, %.1f s", what_.c_str(), steps_, elapsed);
  std::string count;
  if (done > 0 && done * kTelling < total) {
    count = formatted("; %zu of %zu done", done, total);
  } else if (done > 0) {
    const double left = (elapsed - counted_since_) / static_cast<double>(done) * static_cast<double>(total - done);
    count = formatted("; %zu of %zu done, %.0f s left", done, total, left);
  } else if (total > 0) {
    count = formatted("; 0 of %zu done", total);
  }
  const bool bar = style_ == Progress::Style::bar;
  out_ << (bar ? "\r" : "") << head << count << "] " << step << (bar ? "\033[K" : "\n") << std::flush;
}

void StepProgress::finish() {
  if (style_ == Progress::Style::bar && steps_ > 0) out_ << std::endl;
  steps_ = 0;
}

}  // namespace tissue_stiffness
