// SPDX-License-Identifier: MIT
#include "common/mesh_input.h"

#include <utility>

#include "common/sha256.h"
#include "common/signals.h"
#include "mesh/file_bytes.h"
#include "mesh/readers.h"

namespace meshbound::tools {

InputFile read_file(const std::string& path, bool with_checksum) {
  (void)format_of(path);  // an unknown extension is the better message where both are wrong
  const FileBytes bytes(path, &interrupted());
  return {parse_mesh(path, bytes.bytes(), {&interrupted()}), with_checksum ? sha256(bytes.bytes()) : ""};
}

TriangleMesh read_input(const std::string& path, bool with_checksum, MeshReport& report) {
  InputFile file = read_file(path, with_checksum);
  MeshFile& content = file.content;
  report = {path,
            summarise(content.mesh),
            content.triangulated_polygons,
            content.decoded_strips,
            content.ignored_elements,
            content.dropped,
            std::move(file.sha256)};
  return std::move(content.mesh);
}

}  // namespace meshbound::tools
