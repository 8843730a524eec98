// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "decimation/decimation_options.h"
#include "view/gltf_view.h"

namespace meshbound::tools {

/// What `lod_chain --scene FILE DIR` is asked.
struct ViewRequest {
  std::string scene;           ///< a file: JSON (tools/schema/scene-1.schema.json) or glTF
  std::string folder, format;  ///< of the levels
  PixelLimit limit;            ///< of a glTF scene
};

/// Makes the levels that the cameras of a scene need, each with a proven distance to its model, writes them to the
/// folder, and says in its view.json who uses which.
[[nodiscard]] int run_view(const DecimationOptions& options, const ViewRequest& request);

}  // namespace meshbound::tools
