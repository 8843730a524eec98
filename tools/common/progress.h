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

/// Sets the style of all bars made from here on. Not thread-safe.
void set_progress_style(ProgressStyle style);

/// "42%, 12 s so far, 17 s left"; the time left is given after two seconds and from 1% on.
[[nodiscard]] std::string progress_text(int percent, double seconds);

/// "simplifying [####    ] 42%, 12 s so far, 17 s left": what fits a terminal of that many columns. The bar is shorter
/// where it is narrow and left out where nothing is left for it; no line is longer than `columns` - 1 bytes.
[[nodiscard]] std::string progress_line(const std::string& label, int percent, double seconds, int columns);

/// Shows the progress of a long step on stderr; nothing when `quiet`. A bar is erased by the destructor. It never goes
/// back: fractions smaller than the largest one so far change nothing.
class ProgressBar {
 public:
  /// `clock` gives the seconds since the start; empty: the system's clock.
  ProgressBar(std::string label, bool quiet, std::function<double()> clock = {});
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction);
  /// Calls `show`; this must outlive it.
  [[nodiscard]] std::function<void(double)> callback() {
    return [this](double fraction) { show(fraction); };
  }

 private:
  void draw_bar() const;

  std::string label_;
  ProgressStyle style_;
  std::function<double()> clock_;
  int shown_percent_ = -1;
  double last_line_ = 0;  ///< seconds
};

}  // namespace meshbound::tools
