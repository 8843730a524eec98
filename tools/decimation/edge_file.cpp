// SPDX-License-Identifier: MIT
#include "decimation/edge_file.h"

#include <string>

#include "mesh/file_bytes.h"
#include "mesh/mesh_source.h"
#include "mesh/text_cursor.h"

namespace meshbound::tools {
namespace {

std::uint32_t read_vertex(TextCursor& cursor, std::size_t vertices) {
  if (!cursor.find_word_in_line()) cursor.fail("an edge needs the indices of two vertices");
  const std::size_t start = cursor.offset();
  const std::int64_t vertex = cursor.integer("the index of a vertex");
  if (vertex >= 0 && static_cast<std::uint64_t>(vertex) < vertices) return static_cast<std::uint32_t>(vertex);
  cursor.seek(start);
  cursor.fail("vertex " + std::to_string(vertex) + " is not in the mesh, whose vertices are 0 to " +
              std::to_string(vertices - 1));
}

}  // namespace

std::vector<Edge> read_edges(const std::filesystem::path& path, std::size_t vertices, const StopToken& stop) {
  const FileBytes file(path, stop);
  MeshSource source;
  source.path = path;
  source.bytes = file.bytes();
  source.stop = stop;
  TextCursor cursor(source);
  std::vector<Edge> edges;
  while (cursor.find_word()) {
    const std::uint32_t from = read_vertex(cursor, vertices), to = read_vertex(cursor, vertices);
    edges.push_back({from, to});
    if (cursor.find_word_in_line()) cursor.fail("an edge has two vertices only");
  }
  return edges;
}

}  // namespace meshbound::tools
