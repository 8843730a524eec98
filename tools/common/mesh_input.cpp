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

InputFile read_file(const std::string& path, bool with_checksum, const StopToken& stop, bool with_attributes) {
  (void)format_of(path);  // an unknown extension is the better message where both are wrong
  const auto parsed = [&](std::string_view bytes) -> InputFile {
    const auto look = [&] { end_if_stopped(stop, path, "read"); };
    return {parse_mesh(path, bytes, {stop.cancel, stop.deadline, with_attributes}),
            with_checksum ? sha256(bytes, look) : ""};
  };
  return is_stream_path(path) ? parsed(read_standard_input(stop)) : parsed(FileBytes(path, stop).bytes());
}

MeshReport report_of(const std::string& path, const MeshFile& content, const MeshSummary& summary, std::string sha256) {
  return {as_typed(path),
          summary,
          content.triangulated_polygons,
          content.decoded_strips,
          content.ignored_elements,
          content.dropped,
          std::move(sha256),
          content.rest_pose_parts};
}

TriangleMesh read_input(const std::string& path, bool with_checksum, MeshReport& report, const StopToken& stop,
                        MeshAttributes* attributes) {
  InputFile file = read_file(path, with_checksum, stop, attributes != nullptr);
  MeshFile& content = file.content;
  report = report_of(path, content, summarise(content.mesh), std::move(file.sha256));
  if (attributes != nullptr) *attributes = std::move(content.attributes);
  return std::move(content.mesh);
}

std::unique_ptr<StoredMesh> read_stored_input(const std::string& path, bool with_checksum, MeshReport& report,
                                              const StopToken& stop, TileWorkers& workers) {
  auto mesh = std::make_unique<MeshInSpace>(workers.space());
  Sha256 sum;
  FileWindow::Reader reader;
  if (with_checksum) reader = [&](std::string_view bytes) { sum.add(bytes); };
  MeshFile content;
  if (is_stream_path(path)) {
    const std::string bytes = read_standard_input(stop);
    if (with_checksum) sum.add(bytes);
    content = parse_mesh_into(path, bytes, stop, *mesh);
  } else {
    content = workers.read(path, stop, *mesh, reader);
  }
  report = report_of(path, content, summarise(*mesh), with_checksum ? sum.digits() : "");
  return mesh;
}

}  // namespace meshbound::tools
