// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "common/mesh_with_tree.h"
#include "mesh/atomic_file.h"
#include "meshbound/distance.h"
#include "meshbound/io.h"
#include "meshbound/line_mesh.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/normal_deviation.h"
#include "meshbound/simplify.h"
#include "meshbound/stop_token.h"
#include "meshbound/texture_deviation.h"
#include "normals/normal_comparison.h"
#include "texture/texture_comparison.h"

namespace meshbound::tools {

/// The feature lines of an original, and the largest distance of a result's lines from them, model units.
struct OriginalLines {
  Bvh tree;  ///< of their `line_mesh`
  double tolerance = 0;
  double rounding = 0;  ///< largest distance that writing may move a vertex
};

/// An original with a texture, and how far a result may move that texture.
struct OriginalTexture {
  const TriangleMesh* mesh = nullptr;          ///< not owned
  const MeshAttributes* attributes = nullptr;  ///< not owned
  double tolerance = 0;                        ///< of the texture deviation, model units
  double error_bound = 0;                      ///< width of the interval that this is measured to, model units
};

/// An original whose faces may turn by so much in a result. Where the file holds floats its vertices are floats too: a
/// face thinner than these round off has no normal that a file could keep.
struct OriginalNormals {
  const TriangleMesh* mesh = nullptr;  ///< not owned
  double tolerance = 0;                ///< degrees
};

/// A mesh file that appears under its name only after its content was measured: `write` puts it under a temporary name,
/// `measure` reads that back, `publish` renames it if it was found to be within the tolerance (or sends it to the
/// device or FIFO of that name). The destructor removes what was not published.
class GatedOutput {
 public:
  /// Throws `InvalidInput` if the extension of `path` is unknown, `IoError` if it cannot be written to. `write` and
  /// `measure` throw `Interrupted` or `Stopped` as `stop` says, all others only as its flag says.
  GatedOutput(std::filesystem::path path, const StopToken& stop, const WriteOptions& options = {});

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  /// Precision of the coordinates in the file. A mesh that has this precision already is written without any rounding.
  [[nodiscard]] Precision precision() const;

  /// Has these workers write meshes, which then have neither lines nor attributes; null: this process does. They must
  /// outlive this.
  void write_by(TileWorkers* workers) { workers_ = workers; }

  /// Makes the verdict include the distance from these lines; null: no lines. They must outlive this.
  void require_lines(const OriginalLines* lines) { original_lines_ = lines; }

  /// Makes `measure` measure the texture deviation as well; absent: it does not.
  void require_texture(const std::optional<OriginalTexture>& texture) { original_texture_ = texture; }
  [[nodiscard]] const std::optional<OriginalTexture>& required_texture() const { return original_texture_; }

  /// Makes `measure` measure how far faces of the original turn; absent: it does not.
  void require_normals(const std::optional<OriginalNormals>& normals) { original_normals_ = normals; }

  /// Writes a mesh under the temporary name. `lines` are edges of the mesh, `attributes` those of its triangles as far
  /// as the format carries them, `turned_faces` is that of its level. Throws `IoError`; `InvalidInput` when a
  /// coordinate leaves the range of the format. After `Stopped` only `write` and `fall_back` may be called.
  void write(const TriangleMesh& mesh, std::span<const Edge> lines = {}, const MeshAttributes& attributes = {},
             std::size_t turned_faces = 0);
  [[nodiscard]] std::size_t turned_faces() const { return found_.turned_faces; }  ///< of what was written

  /// Reads the mesh that was written. Throws as `read_mesh`.
  [[nodiscard]] TriangleMesh written_mesh() const;
  /// As `written_mesh`, with the attributes of its triangles.
  [[nodiscard]] MeshFile written_with_attributes() const;

  /// Measures the distance between the original (a) and the file as it reads (b), and between their lines if these are
  /// required; the verdict is on both. `options.tolerance` must be set. The tree of the original is not built if the
  /// file holds the original.
  const HausdorffDistance& measure(MeshWithTree& original, const DistanceOptions& options);
  [[nodiscard]] Verdict verdict() const { return found_.verdict; }
  /// Measures the distance again, to the `error_bound` of `options`. False, and nothing is changed, where that is not
  /// reached in time.
  [[nodiscard]] bool narrow(MeshWithTree& original, const DistanceOptions& options);
  /// What `narrow` has measured the distance to, model units; absent: it is that of `measure`.
  [[nodiscard]] std::optional<double> narrowed_to() const { return found_.narrowed_to; }
  /// Measures texture and normals, as far as they are required, of a mesh that is not written yet. Where the file reads
  /// like it, `measure` finds that known.
  void look_at(const MeshFile& level, int threads);
  /// The texture deviation of what was measured or looked at last: there if it is required and, after `measure`, the
  /// verdict is Within. `is_texture_within` is false if it is required but was not measured.
  [[nodiscard]] const std::optional<TextureDeviation>& texture_deviation() const { return found_.texture; }
  [[nodiscard]] bool is_texture_within() const;
  /// The deviation of normals, measured and judged like that of the texture.
  [[nodiscard]] const std::optional<NormalDeviation>& normal_deviation() const { return found_.normals; }
  [[nodiscard]] bool are_normals_within() const;
  [[nodiscard]] bool keeps_appearance() const { return is_texture_within() && are_normals_within(); }
  [[nodiscard]] const HausdorffDistance& distance() const { return found_.distance; }
  [[nodiscard]] const std::optional<HausdorffDistance>& line_distance() const { return found_.line_distance; }
  [[nodiscard]] std::size_t line_edges() const { return found_.lines.triangles.size(); }
  /// The measured lines by vertices of `written_mesh()`.
  [[nodiscard]] std::vector<Edge> lines_of(const TriangleMesh& written) const;
  [[nodiscard]] const MeshSummary& summary() const { return found_.summary; }  ///< of the file as it reads
  /// The file that holds what was written, until `publish`.
  [[nodiscard]] const std::filesystem::path& staged() const { return file_->staged(); }
  [[nodiscard]] std::string checksum() const;  ///< SHA-256 of the file; before `publish`

  /// Replaces what was written, if the time ended before it was proven, by the best mesh that is proven: that of
  /// `smaller`, an output with a smaller tolerance (may be null), or else the original. `options` as for `measure`, but
  /// without the time limit, as matching the original with itself takes one pass.
  void fall_back(const GatedOutput* smaller, MeshWithTree& original, std::span<const Edge> lines,
                 const MeshAttributes& attributes, DistanceOptions options);

  /// Throws `Error` unless the verdict is Within and `keeps_appearance`, `IoError` when the file cannot be renamed.
  void publish();

  /// Writes a copy of a mesh that was found too far, for those who look for the reason.
  void copy_rejected_to(const std::filesystem::path& path) const;

 private:
  /// What is known of a file that was written.
  struct Found {
    Verdict verdict = Verdict::Undecided;
    HausdorffDistance distance;
    std::optional<double> narrowed_to;
    TriangleMesh lines;
    std::optional<HausdorffDistance> line_distance;
    std::optional<TextureDeviation> texture;
    std::optional<NormalDeviation> normals;
    MeshSummary summary;
    std::size_t turned_faces = 0;
  };

  void restart();
  void measure_lines(const TriangleMesh& written, DistanceOptions options);
  void measure_texture(const MeshFile& level, int threads);
  [[nodiscard]] StopToken only_flag() const { return {.cancel = stop_.cancel}; }
  [[nodiscard]] MeshFile written_file(const StopToken& stop, bool with_attributes) const;

  std::filesystem::path path_;  ///< as named by the user
  StopToken stop_;
  WriteOptions options_;
  std::unique_ptr<AtomicFile> file_;
  TileWorkers* workers_ = nullptr;
  // What is required beside the tolerance of the surface.
  const OriginalLines* original_lines_ = nullptr;
  std::optional<OriginalTexture> original_texture_;
  std::optional<OriginalNormals> original_normals_;

  TextureComparison texture_comparison_;
  NormalComparison normal_comparison_;
  /// A mesh whose normals were measured, so that they are known where the file reads like it.
  struct LookedAt {
    TriangleMesh mesh;
    NormalDeviation normals;
  };
  std::optional<LookedAt> looked_at_;
  Found found_;
};

}  // namespace meshbound::tools
