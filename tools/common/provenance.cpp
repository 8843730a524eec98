// SPDX-License-Identifier: MIT
#include "common/provenance.h"

#include <array>
#include <ctime>

namespace meshbound::tools {
namespace {

Provenance remembered;

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 32> text{};
  return {text.data(), std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

void remember_command_line(const std::string& tool, int argc, const char* const* argv) {
  remembered.tool = tool;
  remembered.version = MESHBOUND_VERSION;
  remembered.command.assign(argv, argv + argc);
}

Provenance provenance() {
  Provenance now = remembered;
  now.date = utc_now();
  return now;
}

}  // namespace meshbound::tools
