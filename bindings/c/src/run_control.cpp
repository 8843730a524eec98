// SPDX-License-Identifier: MIT
#include "run_control.h"

#include <new>

mb_cancel* mb_cancel_new() { return new (std::nothrow) mb_cancel; }

void mb_cancel_request(mb_cancel* cancel) {
  if (cancel != nullptr) cancel->requested = true;
}

void mb_cancel_reset(mb_cancel* cancel) {
  if (cancel != nullptr) cancel->requested = false;
}

void mb_cancel_free(mb_cancel* cancel) { delete cancel; }
