// SPDX-License-Identifier: MIT
#include "cancel.h"

#include <new>

using meshbound::c_interface::CallFlag;

static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<CallFlag*>::is_always_lock_free,
              "mb_cancel_request may be called from signal handlers");

mb_cancel::~mb_cancel() {
  for (CallFlag* flag = flags_; flag != nullptr;) {
    CallFlag* const next = flag->next;
    delete flag;
    flag = next;
  }
}

CallFlag& mb_cancel::take_flag() {
  CallFlag* flag = flags_;
  for (; flag != nullptr; flag = flag->next) {
    bool is_taken = false;
    if (flag->is_taken.compare_exchange_strong(is_taken, true)) break;
  }
  if (flag == nullptr) {
    flag = new CallFlag;
    flag->next = flags_;
    while (!flags_.compare_exchange_weak(flag->next, flag)) {
    }
  }
  // In this order, the reverse of that in `request`: whatever comes between, a request is seen here or sets the flag.
  flag->is_set = false;
  if (requested) flag->is_set = true;
  return *flag;
}

void mb_cancel::request() {
  requested = true;
  for (CallFlag* flag = flags_; flag != nullptr; flag = flag->next) flag->is_set = true;
}

mb_cancel* mb_cancel_new() { return new (std::nothrow) mb_cancel; }

void mb_cancel_request(mb_cancel* cancel) {
  if (cancel != nullptr) cancel->request();
}

void mb_cancel_reset(mb_cancel* cancel) {
  if (cancel != nullptr) cancel->requested = false;
}

void mb_cancel_free(mb_cancel* cancel) { delete cancel; }
