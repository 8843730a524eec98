// SPDX-License-Identifier: MIT
#include "mesh/file_stop.h"

#include <string>

#include "meshbound/error.h"

namespace meshbound {

void end_if_stopped(const StopToken& stop, const std::filesystem::path& path, const char* action) {
  if (!stop.stopped()) return;
  const std::string when = std::string(" while it was ") + action;
  if (stop.cancelled()) throw Interrupted(path.string() + ": interrupted" + when);
  throw Stopped(path.string() + ": the time limit came" + when);
}

}  // namespace meshbound
