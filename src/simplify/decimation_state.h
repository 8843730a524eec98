// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/bvh.h"
#include "simplify/cover/cover_assignment.h"
#include "simplify/cover/local_tolerance.h"
#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/feature_lines.h"
#include "simplify/mesh/quadric.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// Points of the original, each with the face of the mesh that it was found nearest to: its vertices, and points
/// between them where they lie far apart. A guide, not a bound.
///
/// A face that grows large would have more than it needs: half of them then go with another one near, which stands for
/// both. They keep to its face from then on.
class Samples {
 public:
  static constexpr std::uint32_t none = ArrayMesh::none;

  Samples() = default;
  /// Vertices of the original, and points on edges longer than `spacing`, between them.
  Samples(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
          const ArrayMesh& mesh, const std::vector<std::uint32_t>& triangle_of_face,
          const std::vector<std::uint32_t>& vertex_of_vertex, double spacing);
  /// Vertices and points on edges of an original that the mesh has left already, each with the nearest of the faces
  /// that cover its triangle. Originals without a cover have none.
  Samples(const std::vector<Vec3>& vertices, const std::vector<std::array<std::uint32_t, 3>>& triangles,
          const ArrayMesh& mesh, const CoverAssignment& cover, double spacing);

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] Vec3 at(std::uint32_t sample) const { return samples_[sample].at; }
  [[nodiscard]] std::uint32_t triangle_near(std::uint32_t sample) const { return triangle_near_[sample] & ~at_edge; }
  /// Whether it lies on a border or a crease, where distances are largest: no other one can stand for it.
  [[nodiscard]] bool is_at_edge(std::uint32_t sample) const { return (triangle_near_[sample] & at_edge) != 0; }
  /// None where no face is known.
  [[nodiscard]] std::uint32_t face_of(std::uint32_t sample) const {
    while ((samples_[sample].following & goes_with) != 0 && samples_[sample].following != none)
      sample = samples_[sample].face;
    return samples_[sample].face;
  }
  /// The samples of a face form a list; those that go with others are not in it.
  [[nodiscard]] std::uint32_t first(std::uint32_t face) const { return first_[face]; }
  [[nodiscard]] std::uint32_t following(std::uint32_t sample) const { return samples_[sample].following; }

  /// The sample is going to be asked for.
  void prefetch(std::uint32_t sample) const { __builtin_prefetch(&samples_[sample]); }

  /// Empties the list of the face; its samples must be given to other faces then.
  void clear(std::uint32_t face) { first_[face] = none; }
  void give_to(std::uint32_t sample, std::uint32_t face) {
    samples_[sample].face = face;
    samples_[sample].following = first_[face];
    first_[face] = sample;
  }
  /// The sample keeps to the face of `other` from now on, and is in no list.
  void go_with(std::uint32_t sample, std::uint32_t other) {
    samples_[sample].face = other;
    samples_[sample].following = goes_with;
  }

 private:
  /// Points between p and q that are at most `spacing` apart, as far as they are not too many.
  template <class FaceAt>
  void add_between(Vec3 p, Vec3 q, double spacing, std::uint32_t triangle_and_mark, const FaceAt& face_at);

  static constexpr std::uint32_t goes_with = 0x80000000, at_edge = 0x80000000;
  struct alignas(32) Sample {
    Vec3 at;
    std::uint32_t face = none, following = none;
  };
  std::vector<Sample> samples_;
  std::vector<std::uint32_t> triangle_near_, first_;
};

/// When an edge that was refused may be worth another trial.
enum class Hope : std::uint8_t {
  WithMoreTolerance,  ///< a larger share of the tolerance, or a change around it
  AfterChange,        ///< something changes around it
  OfOtherEnds         ///< one of its ends moves: it was refused by a wide margin
};

/// One change of the mesh that has not been proven yet, and what was before.
struct Edit {
  enum class Kind : std::uint8_t { Collapse, Move, Flip } kind = Kind::Collapse;
  bool was_locked = false;
  Corner edge = ArrayMesh::none;  ///< collapsed or flipped; for a move a corner of the vertex
  Vec3 position;                  ///< of the start of the edge
  FeatureLines::Before lines;     ///< at the edge of a collapse
  std::uint32_t first_stamp = 0;  ///< its faces in `EditLog::stamps`
};

/// Changes in their order. The number of the first one is `before + 1`.
struct EditLog {
  struct Stamp {
    std::uint32_t face, before;  ///< the number of the change before that touched the face; 0: none
  };
  std::uint32_t before = 0;
  std::vector<Edit> edits;
  std::vector<Stamp> stamps;
  std::vector<CornerCoordinates> coordinates;  ///< by stamp: those of the face before; empty without a texture

  [[nodiscard]] std::uint32_t last_number() const { return before + static_cast<std::uint32_t>(edits.size()); }
  void clear() { edits.clear(), stamps.clear(), coordinates.clear(); }
  /// The faces that change `number` has touched.
  [[nodiscard]] std::span<const Stamp> stamps_of(std::uint32_t number) const {
    const std::size_t k = number - before - 1, begin = edits[k].first_stamp;
    const std::size_t end = k + 1 < edits.size() ? edits[k + 1].first_stamp : stamps.size();
    return std::span(stamps).subspan(begin, end - begin);
  }
};

/// A part of the mesh that one thread changes, see `Split`.
struct Region {
  std::uint32_t id = 0;
  EditLog log;  ///< of what has not been proven
  std::size_t removed_faces = 0;
  std::uint32_t clock = 0;
  std::vector<std::uint32_t> vertices;  ///< of the region; empty where it is the whole mesh
};

/// A mesh under decimation and all that is known of it.
///
/// `mesh` is proven to be within the tolerance of the original, both ways, but for the faces with a stamp: these were
/// changed since, and `logs` can take the changes back. All coordinates are those of the working frame.
struct DecimationState {
  /// A mesh that is the original, triangle by triangle: `triangle_of_face` says which, and `vertex_of_vertex` which
  /// vertex of the original is at the same place. The original must outlive this. Samples are still to be set.
  DecimationState(const std::vector<Vec3>& original_vertices,
                  const std::vector<std::array<std::uint32_t, 3>>& original_triangles, const Bvh& original_tree,
                  ArrayMesh start, std::vector<std::uint32_t> vertex_of_vertex,
                  std::vector<std::uint32_t> triangle_of_face);
  /// A mesh that is proven already, with the originals that cover its faces: `cover_of(t)` are faces that original t is
  /// proven to be near, `near` has an original near each face. `vertex_of_vertex` and `triangle_of_face` are numbers of
  /// what the caller started from. The original must outlive this. Samples are still to be set.
  DecimationState(const std::vector<Vec3>& original_vertices,
                  const std::vector<std::array<std::uint32_t, 3>>& original_triangles, const Bvh& original_tree,
                  ArrayMesh start, std::vector<std::uint32_t> vertex_of_vertex,
                  std::vector<std::uint32_t> triangle_of_face, std::vector<std::uint32_t> near,
                  CoverAssignment cover_of);
  /// Takes samples for proposals of this tolerance.
  void set_samples(double for_tolerance);
  /// Between samples on an edge of the original, in tolerances: a face may be nearer than that to both ends of an edge
  /// and miss its middle. Half as much costs a tenth more time for as many faces, twice as much 4% more faces.
  static constexpr double spacing_of_samples = 3;

  const std::vector<Vec3>& vertices;                           ///< of the original
  const std::vector<std::array<std::uint32_t, 3>>& triangles;  ///< of the original
  const Bvh& tree;                                             ///< of the original

  ArrayMesh mesh;
  std::size_t faces = 0;  ///< those left
  std::vector<std::uint32_t> source_vertex,
      source_triangle;               ///< by vertex and face: where it comes from in the original
  std::vector<std::uint8_t> locked;  ///< by vertex
  std::vector<Quadric> quadrics;     ///< by vertex
  std::vector<float> share;          ///< by vertex: share of the tolerance that samples may reach
  Samples samples;

  double magnitude = 0;  ///< largest coordinate of the original
  double tolerance = 0;
  double limit = 0;  ///< what must be found in doubles so that `tolerance` holds
  FeatureLines lines;
  double line_tolerance = HUGE_VAL;  ///< of `lines`, where it is smaller than `tolerance`
  double line_limit = 0;             ///< what must be found in doubles so that both hold for lines
  bool keeps_positions = false;      ///< vertices stand only where the original has vertices
  std::optional<LocalTolerance> local;
  std::optional<TextureMap> texture;  ///< where the texture must not move too far

  std::vector<std::uint32_t> stamp;  ///< by face: the number of the last change since the last proof, or 0
  std::vector<EditLog> logs;         ///< since the last proof, their numbers ascending
  [[nodiscard]] std::uint32_t last_number() const { return logs.empty() ? 0 : logs.back().last_number(); }
  std::uint32_t clock = 0;                         ///< changes since the beginning
  std::vector<std::uint32_t> touched, refused_at;  ///< by vertex and edge: clock of the last change or refusal
  std::vector<Hope> hope;                          ///< by edge: what may help one that was refused
  std::vector<std::uint32_t> index_in_queue;       ///< by edge

  /// All proofs hold for a larger tolerance as well, and what was refused may fit now. Not for a smaller one.
  void grow_tolerance(double to);
  /// What must be found in doubles so that `value` holds in real arithmetic.
  [[nodiscard]] double provable(double value) const;
  /// What must be found in doubles around a triangle so that the tolerances hold there.
  [[nodiscard]] double limit_around(const std::array<Vec3, 3>& corners) const;
  [[nodiscard]] double limit_in(const Eigen::AlignedBox3d& box) const {
    return local ? provable(local->sufficient_around(box, tolerance)) : limit;
  }
  std::vector<std::uint32_t> kept;     ///< original triangles without a face near: part of every result as they are
  std::vector<std::uint8_t> is_kept;   ///< by original triangle; empty: none is
  bool starts_as_original = true;      ///< the mesh was the original when the decimation began
  CoverAssignment cover;               ///< which faces each original triangle is proven to be near
  std::vector<std::uint32_t> nearest;  ///< by face: an original triangle near it
};

}  // namespace meshbound
