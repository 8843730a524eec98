// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::tools {

/// Has the threads of GNU's OpenMP wait for each other actively for some 60 microseconds, which is longer than most
/// of the serial parts between parallel ones, and asleep from then on. By default they burn 6 ms at each wait, which is
/// harmless while every thread has a processor and makes two threads several times slower than one where other programs
/// hold one of them. OpenMP reads this from the environment before `main`, so a constructor sets it earlier still,
/// unless the environment says how to wait already. That is early enough where libgomp is linked statically (see
/// cmake/StaticLibraries.cmake); elsewhere it has no effect. Calling this keeps the constructor in the program.
void limit_omp_spin();

}  // namespace meshbound::tools
