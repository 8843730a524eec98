// SPDX-License-Identifier: GPL-3.0-or-later
// Linked with the source of simplify_with_bound: the tool as it is, with a monitor that proves too little.
#include "simplify/tracker_fault.h"

namespace {

struct InjectFault {
  InjectFault() { meshbound::internal::tracker_fault = 1.5; }
};
const InjectFault inject_fault;

}  // namespace
