// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::tools {

/// Has the threads of GNU's OpenMP wait for each other actively for some 60 microseconds, which is longer than most
/// of the serial parts between parallel ones, and asleep from then on. By default they burn 6 ms at each wait, which is
/// harmless while every thread has a processor and makes two threads several times slower than one where other programs
/// hold one of them. OpenMP reads this from the environment before `main` only, so the program starts itself anew,
/// once, unless the environment says how to wait already. Does nothing on other systems, or where that fails. To be
/// called before anything else.
void wait_briefly(const char* const* argv);

}  // namespace meshbound::tools
