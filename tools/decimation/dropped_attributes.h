// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "meshbound/io.h"

namespace meshbound::tools {

/// "6553 texture coordinates, 1 material": each count that is not 0, in words.
[[nodiscard]] std::string listed(const DroppedAttributes& dropped);

}  // namespace meshbound::tools
