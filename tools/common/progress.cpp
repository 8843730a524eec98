// SPDX-License-Identifier: MIT
#include "common/progress.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "common/stopwatch.h"

namespace meshbound::tools {
namespace {

constexpr double seconds_between_lines = 10;
constexpr double seconds_until_estimate = 2;
constexpr int usual_columns = 80;

ProgressStyle chosen_style = ProgressStyle::Automatic;

ProgressStyle style_of(bool quiet) {
  if (quiet) return ProgressStyle::Off;
  const bool would_be_seen = chosen_style != ProgressStyle::Automatic || isatty(STDERR_FILENO) != 0;
  return would_be_seen ? chosen_style : ProgressStyle::Off;
}

/// The width of the terminal that shows stderr, in characters.
int columns_of_terminal() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : usual_columns;
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

std::string progress_line(const std::string& label, int percent, double seconds, int columns) {
  constexpr int longest_bar = 40;
  constexpr int room_for_text = sizeof " [] 100%, 9999 s so far, 9999 s left";  // the bar keeps its length meanwhile
  const int bar = std::clamp(columns - static_cast<int>(label.size()) - room_for_text, 0, longest_bar);
  const int filled = percent * bar / 100;
  std::string line = label + " ";
  if (bar > 0)
    line += "[" + std::string(static_cast<std::size_t>(filled), '#') +
            std::string(static_cast<std::size_t>(bar - filled), ' ') + "] ";
  line += (percent < 10 ? " " : "") + progress_text(percent, seconds);
  line.resize(std::min(line.size(), static_cast<std::size_t>(std::max(columns - 1, 0))));
  return line;
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
  std::fprintf(stderr, "\r%s\033[K", progress_line(label_, shown_percent_, clock_(), columns_of_terminal()).c_str());
  std::fflush(stderr);
}

}  // namespace meshbound::tools
