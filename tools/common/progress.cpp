// SPDX-License-Identifier: MIT
#include "common/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/stopwatch.h"

namespace meshbound::tools {
namespace {

constexpr double seconds_between_lines = 10;
constexpr double seconds_until_estimate = 2;

ProgressStyle chosen_style = ProgressStyle::Automatic;

ProgressStyle style_of(bool quiet) {
  if (quiet) return ProgressStyle::Off;
  const bool would_be_seen = chosen_style != ProgressStyle::Automatic || isatty(STDERR_FILENO) != 0;
  return would_be_seen ? chosen_style : ProgressStyle::Off;
}

std::string whole_seconds(double seconds) { return std::to_string(static_cast<long long>(seconds)) + " s"; }

}  // namespace

void set_progress_style(ProgressStyle style) { chosen_style = style; }

std::string progress_text(int percent, double seconds) {
  std::string text = std::to_string(percent) + "%";
  if (seconds < seconds_until_estimate || percent < 1) return text;
  return text + ", " + whole_seconds(seconds) + " so far, " + whole_seconds(seconds / percent * (100 - percent)) +
         " left";
}

ProgressBar::ProgressBar(std::string label, bool quiet, std::function<double()> clock)
    : label_(std::move(label)), style_(style_of(quiet)), clock_(std::move(clock)) {
  if (!clock_) clock_ = [watch = Stopwatch()] { return watch.seconds(); };
}

ProgressBar::~ProgressBar() {
  if (style_ == ProgressStyle::Automatic && shown_percent_ >= 0) std::fputs("\r\033[K", stderr);
}

void ProgressBar::show(double fraction) {
  if (style_ == ProgressStyle::Off) return;
  const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
  const bool has_grown = percent > shown_percent_;
  shown_percent_ = std::max(shown_percent_, percent);
  if (style_ == ProgressStyle::Automatic) {
    if (has_grown) draw_bar();
    return;
  }
  const double now = clock_();
  if (now < last_line_ + seconds_between_lines) return;
  last_line_ = now;
  std::fprintf(stderr, "%s: %s\n", label_.c_str(), progress_text(shown_percent_, now).c_str());
}

void ProgressBar::draw_bar() const {
  constexpr int width = 40;
  const int filled = shown_percent_ * width / 100;
  std::fprintf(stderr, "\r%s [%s%s] %s%s\033[K", label_.c_str(),
               std::string(static_cast<std::size_t>(filled), '#').c_str(),
               std::string(static_cast<std::size_t>(width - filled), ' ').c_str(), shown_percent_ < 10 ? " " : "",
               progress_text(shown_percent_, clock_()).c_str());
  std::fflush(stderr);
}

}  // namespace meshbound::tools
