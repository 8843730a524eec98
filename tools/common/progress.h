// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace meshbound::tools {

/// A progress bar on stderr, drawn only when that is a terminal and `quiet` is false, and wiped when it goes. It never
/// goes back: smaller fractions than the largest one so far change nothing.
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(double fraction);

 private:
  std::string label_;
  bool enabled_;
  int shown_percent_ = -1;
};

}  // namespace meshbound::tools
