// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/mesh_source.h"
#include "meshbound/io.h"

namespace meshbound {

/// How messages name a position in a file: by line in text, by byte in binary files.
enum class Position { Line, Byte };

/// Collects what a reader finds into triangles, and refuses at the end what no bound can be given for. Indices must
/// have been checked against the vertex count by the reader, which knows where in the file they stand.
class MeshAssembler {
 public:
  MeshAssembler(const MeshSource& source, Position position) : source_(source), position_(position) {}

  void reserve(std::size_t vertices, std::size_t triangles);

  /// `offset` is the byte of the file where the vertex starts.
  void add_vertex(const Eigen::Vector3d& p, std::size_t offset) {
    if (file_.mesh.vertices.size() % look_interval == 0) look();
    if (!usable(p)) suspects_.push_back({vertex_count(), offset});
    file_.mesh.vertices.push_back(p);
  }

  /// Adds the fan of triangles from the first corner. A polygon of fewer than three corners is counted as ignored.
  void add_polygon(std::span<const std::uint32_t> corners);

  /// Adds a triangle strip of 32-bit indices, in which -1 starts a new strip. Every second triangle is turned over, so
  /// that all face the same way. Triangles that repeat a corner only join two runs of the strip and are dropped.
  void add_strips(std::span<const std::int64_t> corners);

  void ignore_element() { ++file_.ignored_elements; }

  /// Counts of the attributes that the reader skips, for the reader to increase.
  [[nodiscard]] DroppedAttributes& dropped() { return file_.dropped; }

  [[nodiscard]] bool has_triangles() const { return !file_.mesh.triangles.empty(); }        ///< that no sink has taken
  [[nodiscard]] std::size_t triangle_count() const { return file_.mesh.triangles.size(); }  ///< likewise
  [[nodiscard]] std::size_t vertex_count() const { return vertices_given_ + file_.mesh.vertices.size(); }

  /// Returns the mesh, without what the source's sink has taken, and leaves the assembler empty. Throws `InvalidInput`
  /// when there are no triangles or one uses a coordinate that is not finite or beyond `largest_coordinate`.
  [[nodiscard]] MeshFile finish();
  /// For a share of a file: gives the rest to the sink. Nothing where the whole file must be seen to tell what it
  /// holds: where a face was no triangle or a vertex has an unusable coordinate.
  [[nodiscard]] std::optional<MeshFile> finish_share();

 private:
  static constexpr std::size_t look_interval = 1 << 16;  // vertices or triangles: read in some milliseconds

  struct Suspect {
    std::size_t vertex;
    std::size_t offset;
  };

  void look();
  void give();
  [[nodiscard]] std::vector<bool> used() const;
  static bool usable(const Eigen::Vector3d& p);
  void add_strip(std::span<const std::int64_t> corners);
  void refuse_used_suspects() const;
  [[noreturn]] void fail(std::size_t offset, const std::string& defect) const;

  const MeshSource& source_;
  Position position_;
  MeshFile file_;
  std::size_t vertices_given_ = 0;  // to the sink of the source, if there is one
  std::vector<Suspect> suspects_;   // vertices with an unusable coordinate: harmless until a triangle uses them
};

}  // namespace meshbound
