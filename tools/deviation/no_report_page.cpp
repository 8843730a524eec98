// SPDX-License-Identifier: MIT
#include "deviation/report_page.h"

namespace meshbound::tools {

std::optional<std::string_view> report_page() { return std::nullopt; }

}  // namespace meshbound::tools
