// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string_view>

namespace meshbound::tools {

/// The HTML page of a report without its data, for which `@@DOCUMENT@@` and `@@SCENE@@` stand. Absent in a build that
/// was configured without npm, from which three.js comes.
[[nodiscard]] std::optional<std::string_view> report_page();

}  // namespace meshbound::tools
