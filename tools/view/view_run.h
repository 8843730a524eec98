// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "decimation/decimation_options.h"

namespace meshbound::tools {

/// `lod_chain --scene FILE DIR`: makes the levels that the cameras of a scene need, each with a proven distance to its
/// model, writes them to the folder as <format> files, and says in its view.json who uses which.
[[nodiscard]] int run_view(const DecimationOptions& options, const std::string& scene, const std::string& folder,
                           const std::string& format);

}  // namespace meshbound::tools
