// SPDX-License-Identifier: MIT
#include "run_control.h"

#include "meshbound/error.h"

namespace meshbound::c_interface {
namespace {

/// Between two calls of the caller's progress function. The library reports up to a thousand times a second, and the
/// function may be as slow as drawing a window.
constexpr std::chrono::milliseconds between_reports{100};

}  // namespace

RunControl::RunControl(mb_cancel* cancel, mb_progress function, void* user) : progress_(function), user_(user) {
  if (cancel == nullptr) return;
  flag_ = &cancel->requested;
  if (function == nullptr) return;
  taken_ = &cancel->take_flag();
  flag_ = &taken_->is_set;
}

RunControl::~RunControl() {
  if (taken_ != nullptr) taken_->is_taken = false;
}

std::function<void(double)> RunControl::progress() {
  if (progress_ == nullptr) return {};
  return [this](double fraction) { report(fraction); };
}

void RunControl::finish() {
  if (progress_ != nullptr && told_ != 1 && !*flag_) tell(1);
  if (*flag_) throw Interrupted("cancelled");
}

void RunControl::report(double fraction) {
  if (!told_at_ || Clock::now() - *told_at_ >= between_reports) tell(fraction);
}

void RunControl::tell(double fraction) {
  told_ = fraction;
  if (progress_(fraction, user_) != 0) *flag_ = true;
  told_at_ = Clock::now();
}

}  // namespace meshbound::c_interface
