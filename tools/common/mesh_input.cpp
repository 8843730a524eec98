// SPDX-License-Identifier: MIT
#include "common/mesh_input.h"

#include <string_view>
#include <utility>

#include "common/sha256.h"
#include "common/standard_streams.h"
#include "mesh/file_bytes.h"
#include "mesh/file_stop.h"
#include "mesh/readers.h"
#include "meshbound/error.h"

namespace meshbound::tools {

bool has_mesh_extension(const std::filesystem::path& path) {
  try {
    (void)format_of(path);
    return true;
  } catch (const InvalidInput&) {
    return false;
  }
}

InputFile read_file(const std::string& path, bool with_checksum, const StopToken& stop, bool with_attributes,
                    TileWorkers* workers) {
  (void)format_of(path);  // an unknown extension is the better message where both are wrong
  const auto parsed = [&](std::string_view bytes) -> InputFile {
    const auto look = [&] { end_if_stopped(stop, path, "read"); };
    return {parse_mesh(path, bytes, {stop.cancel, stop.deadline, with_attributes}),
            with_checksum ? sha256(bytes, look) : ""};
  };
  if (workers != nullptr)
    if (const std::optional<std::string> bytes = workers->read(path, stop)) return parsed(*bytes);
  return is_stream_path(path) ? parsed(read_standard_input(stop)) : parsed(FileBytes(path, stop).bytes());
}

TriangleMesh read_input(const std::string& path, bool with_checksum, MeshReport& report, const StopToken& stop,
                        MeshAttributes* attributes, TileWorkers* workers) {
  InputFile file = read_file(path, with_checksum, stop, attributes != nullptr, workers);
  MeshFile& content = file.content;
  report = {as_typed(path),           summarise(content.mesh), content.triangulated_polygons, content.decoded_strips,
            content.ignored_elements, content.dropped,         std::move(file.sha256),        content.rest_pose_parts};
  if (attributes != nullptr) *attributes = std::move(content.attributes);
  return std::move(content.mesh);
}

}  // namespace meshbound::tools
