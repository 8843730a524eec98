// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <string>

namespace meshbound::tools {

enum class ProgressStyle {
  Automatic,  ///< a bar where stderr is a terminal
  Plain,      ///< a line every ten seconds, for logs
  Off
};

/// For all bars that are made from now on. Not thread-safe.
void set_progress_style(ProgressStyle style);

/// "42%, 12 s so far, 17 s left"; what is left is told after two seconds, and never below 1%.
[[nodiscard]] std::string progress_text(int percent, double seconds);

/// How far a long step is, on stderr; nothing when `quiet`. A bar is wiped when it goes, and it never goes back:
/// smaller fractions than the largest one so far change nothing.
class ProgressBar {
 public:
  /// `clock` gives the seconds since the beginning; empty: by the clock of the system.
  ProgressBar(std::string label, bool quiet, std::function<double()> clock = {});
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction);

 private:
  void draw_bar() const;

  std::string label_;
  ProgressStyle style_;
  std::function<double()> clock_;
  int shown_percent_ = -1;
  double last_line_ = 0;  ///< seconds
};

}  // namespace meshbound::tools
