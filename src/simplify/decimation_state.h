// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "meshbound/bvh.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"
#include "proof/edge_neighbours.h"
#include "simplify/cover/clustered_original.h"
#include "simplify/cover/cover_assignment.h"
#include "simplify/cover/local_tolerance.h"
#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/edge_notes.h"
#include "simplify/mesh/feature_lines.h"
#include "simplify/mesh/last_changes.h"
#include "simplify/mesh/quadric.h"
#include "simplify/normals/face_turns.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// Points of the original, each assigned to the face of the mesh that it was found nearest to: the vertices, and points
/// on long edges. They guide decimation and prove nothing. A sample knows its place on a triangle of the original: with
/// its coordinates it would be more than twice as large.
///
/// When a face has more samples than it needs, every second one is attached to another sample nearby that represents
/// both, and stays with that one's face from then on.
class Samples {
 public:
  /// Points between the ends of one edge. With 7 a run takes 10% longer at 0.02% and 4% longer at 0.1%, for as many
  /// faces (37 meshes).
  static constexpr int max_between = 3;

  /// None.
  Samples() = default;
  /// Takes the vertices of the original, and points at most `spacing` apart on longer edges. The original must outlive
  /// this.
  Samples(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, const ArrayMesh& mesh,
          const std::vector<std::uint32_t>& triangle_of_face, const std::vector<std::uint32_t>& source_vertices,
          double spacing, int threads);
  /// Takes samples for a mesh that is no longer the original, to be simplified with this tolerance: each sample gets
  /// the nearest of the faces that cover its triangle. Originals without a cover have no samples. The original must
  /// outlive this.
  Samples(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, const ArrayMesh& mesh,
          const std::vector<TriangleNeighbours>& neighbours, const CoverAssignment& cover, double tolerance);

  [[nodiscard]] std::size_t size() const { return samples_.size(); }
  [[nodiscard]] Vec3 at(std::uint32_t sample) const {
    const Place& place = samples_[sample].place;
    const Triangle& corners = triangles_[triangle_near(sample)];
    const Vec3 from = vertices_[corners[place.from]], to = vertices_[corners[place.to]];
    return from + shares[place.share] * (to - from);
  }
  /// A triangle of the original that has the sample on its boundary.
  [[nodiscard]] std::uint32_t triangle_near(std::uint32_t sample) const {
    return samples_[sample].triangle_and_mark & ~at_edge;
  }
  /// Whether the sample lies on a border or a crease, where distances are largest: no other sample can represent it.
  [[nodiscard]] bool is_at_edge(std::uint32_t sample) const {
    return (samples_[sample].triangle_and_mark & at_edge) != 0;
  }
  /// A sample and the plane of the original there.
  struct Surroundings {
    Vec3 at, normal;
    double max_squared_height = 0;  ///< times the squared length of `normal`; negative at borders and creases
    /// Whether either sample lies in the plane of the other: then a face near one is near the other too, unless it ends
    /// between them.
    [[nodiscard]] bool are_alike(const Surroundings& other) const {
      const Vec3 way = other.at - at;
      const double height = dot(normal, way), height_there = dot(other.normal, way);
      return height * height <= max_squared_height && height_there * height_there <= other.max_squared_height;
    }
  };
  [[nodiscard]] Surroundings around(std::uint32_t sample, double tolerance) const;
  /// The face of a sample; `no_index` if it has none.
  [[nodiscard]] std::uint32_t face_of(std::uint32_t sample) const {
    while ((samples_[sample].following & goes_with) != 0 && samples_[sample].following != no_index)
      sample = samples_[sample].face;
    return samples_[sample].face;
  }
  /// First sample in the list of the face; attached samples are in no list.
  [[nodiscard]] std::uint32_t first(std::uint32_t face) const { return first_[face]; }
  [[nodiscard]] std::uint32_t following(std::uint32_t sample) const { return samples_[sample].following; }

  /// Prefetches a sample that is needed soon.
  void prefetch(std::uint32_t sample) const { __builtin_prefetch(&samples_[sample]); }

  /// Empties the list of the face; the caller must assign its samples to other faces.
  void clear(std::uint32_t face) { first_[face] = no_index; }
  void give_to(std::uint32_t sample, std::uint32_t face) {
    samples_[sample].face = face;
    samples_[sample].following = first_[face];
    first_[face] = sample;
  }
  /// Attaches the sample to `other`: it is in no list from here on and has the face of `other`.
  void go_with(std::uint32_t sample, std::uint32_t other) {
    samples_[sample].face = other;
    samples_[sample].following = goes_with;
  }

 private:
  /// Shares of the way along an edge: none, then those of one point, of two, of three.
  static constexpr std::array<double, 7> shares{0, 1.0 / 2, 1.0 / 3, 2.0 / 3, 1.0 / 4, 2.0 / 4, 3.0 / 4};
  static constexpr std::size_t share_of(int k, int count) { return std::size_t(count * (count - 1) / 2 + k); }
  /// On the way from one corner of a triangle to another.
  struct Place {
    std::uint8_t from = 0, to = 0, share = 0;
  };
  struct Sample {
    std::uint32_t face = no_index, following = no_index, triangle_and_mark = 0;
    Place place;
  };
  static_assert(sizeof(Sample) == 16);

  Samples(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, std::size_t faces)
      : vertices_(vertices), triangles_(triangles), samples_(vertices.size()), first_(faces, no_index) {}
  /// Puts the sample at a vertex on one of its triangles.
  void set_place(std::uint32_t vertex, std::uint32_t triangle, std::size_t corner) {
    samples_[vertex].triangle_and_mark |= triangle;
    samples_[vertex].place.from = samples_[vertex].place.to = static_cast<std::uint8_t>(corner);
  }
  /// Puts so many points between two corners of a triangle, from number `first` on.
  template <class FaceAt>
  void put_between(std::size_t first, std::size_t from, std::size_t to, int count, std::uint32_t triangle_and_mark,
                   const FaceAt& face_at);

  static constexpr std::uint32_t goes_with = 0x80000000, at_edge = 0x80000000;
  std::span<const Vec3> vertices_;  ///< of the original, as its triangles
  std::span<const Triangle> triangles_;
  std::vector<Sample> samples_;  ///< those at the vertices first
  std::vector<std::uint32_t> first_;
};

/// A change of the mesh, with what is needed to undo it.
struct Edit {
  enum class Kind : std::uint8_t { Collapse, Move, Flip } kind = Kind::Collapse;
  bool was_locked = false;
  Corner edge = no_index;  ///< the edge collapsed or flipped; for a move, a corner of the vertex; none: undone
  Vec3 position;           ///< of the start of the edge, before the change
  /// The last changes before of the vertices that it changes: the start of the edge, and the end of one collapsed.
  std::array<std::uint32_t, 2> before{};
};

/// The changes of a region in their order. The first one has the number `before` + 1.
struct EditLog {
  /// What a face had before a change.
  struct FaceTexture {
    std::uint32_t face;
    CornerCoordinates coordinates;
  };
  std::uint32_t before = 0;
  std::vector<Edit> edits;
  std::vector<FeatureLines::Before> lines;  ///< by edit: what was at its edge; empty without lines
  std::vector<FaceTexture> textures;        ///< of the faces that each edit changes; empty without a texture
  std::vector<std::size_t> textures_end;    ///< by edit: where its last one ends; empty without a texture

  [[nodiscard]] std::uint32_t last_number() const { return before + static_cast<std::uint32_t>(edits.size()); }
  void clear() { edits.clear(), lines.clear(), textures.clear(), textures_end.clear(); }
  void shrink_to_fit() {
    edits.shrink_to_fit(), lines.shrink_to_fit();
    textures.shrink_to_fit(), textures_end.shrink_to_fit();
  }
  /// Adds the changes of another log after those here.
  void append(const EditLog& other);
  [[nodiscard]] std::span<const FaceTexture> textures_of(std::size_t edit) const {
    if (textures_end.empty()) return {};
    const std::size_t begin = edit == 0 ? 0 : textures_end[edit - 1];
    return std::span(textures).subspan(begin, textures_end[edit] - begin);
  }
};

/// Makes a collapse or a move, which is still to be made, the last change of its vertices. A flip changes no vertex: it
/// is proven by itself or with the changes around it, and undone by `undo_last` only.
void note(LastChanges& last, const ArrayMesh& mesh, Edit& edit, std::uint32_t number);
/// Once it has been undone: what they had before.
void take_back(LastChanges& last, const ArrayMesh& mesh, const Edit& edit);

/// Changes that are proven, kept so that some of them can be taken back all the same.
struct ProvenChanges {
  explicit ProvenChanges(std::size_t vertices) : last(vertices), logs(1) {}
  /// Takes over changes of the mesh that have been proven, in their order.
  void add(const ArrayMesh& mesh, const EditLog& proven);

  LastChanges last;           ///< of these changes
  std::vector<EditLog> logs;  ///< one
};

/// A part of the mesh that one thread changes, see `Split`.
struct Region {
  std::uint32_t id = 0;
  EditLog log;     ///< unproven changes
  EditLog proven;  ///< changes proven one by one, if these are kept
  std::size_t removed_faces = 0;
  std::vector<std::uint32_t> vertices;  ///< of the region; empty where it is the whole mesh
  /// Vertices that something has changed around, and that have edges to vertices of other regions.
  std::vector<std::uint32_t> changed_at_seams;
};

/// The original of a decimation. What it refers to must outlive it.
struct OriginalOfDecimation {
  const std::vector<Vec3>& vertices;
  const std::vector<Triangle>& triangles;
  const Bvh& tree;                             ///< of the triangles
  std::vector<TriangleNeighbours> neighbours;  ///< across edges
  ClusteredOriginal clustered;
};
/// Finds all of it by one thread.
[[nodiscard]] OriginalOfDecimation original_of_decimation(const std::vector<Vec3>& vertices,
                                                          const std::vector<Triangle>& triangles, const Bvh& tree);

/// Faces that may stay around an edge, at most: a collapse with more is not tried.
inline constexpr std::size_t max_faces_of_star = 48;

/// A mesh under decimation and everything known about it.
///
/// `mesh` is proven to be within the tolerance of the original, both ways, except for faces whose vertices have
/// changed since the last proof, and `logs` can undo the changes. All coordinates are those of the working frame.
struct DecimationState {
  /// A mesh that is the original, triangle by triangle: `triangle_of_face` says which, and `source_vertices` which
  /// vertex of the original is at the same place. Samples are still to be set.
  DecimationState(OriginalOfDecimation original, ArrayMesh start, std::vector<std::uint32_t> source_vertices,
                  std::vector<std::uint32_t> triangle_of_face, int threads = 1);
  /// A mesh that is proven already, with the originals that cover its faces: `cover_of(t)` are faces that original t is
  /// proven to be near, `near` has an original near each face. `source_vertices` and `triangle_of_face` are numbers of
  /// what the caller started from. Samples are still to be set.
  DecimationState(OriginalOfDecimation original, ArrayMesh start, std::vector<std::uint32_t> source_vertices,
                  std::vector<std::uint32_t> triangle_of_face, std::vector<std::uint32_t> near,
                  CoverAssignment cover_of, int threads = 1);
  /// Gives each vertex the planes of the faces that are around it now.
  void reset_quadrics(int threads = 1);
  /// Takes samples for proposals of this tolerance. Where they lie does not depend on the threads.
  void set_samples(double for_tolerance, int threads = 1);
  /// Largest distance between samples on an edge of the original, in tolerances: with samples further apart, a face may
  /// be near both ends of an edge and miss its middle. Half of this costs a tenth more time for as many faces, twice as
  /// much gives 4% more faces.
  static constexpr double spacing_of_samples = 3;

  const std::vector<Vec3>& vertices;                 ///< of the original
  const std::vector<Triangle>& triangles;            ///< of the original
  const Bvh& tree;                                   ///< of the original
  const std::vector<TriangleNeighbours> neighbours;  ///< of the original, across its edges
  const ClusteredOriginal clustered;                 ///< the original

  ArrayMesh mesh;
  std::size_t faces = 0;  ///< those left
  std::vector<std::uint32_t> source_vertex,
      source_triangle;               ///< by vertex and face: where it comes from in the original
  std::vector<std::uint8_t> locked;  ///< by vertex
  /// By face: whether all its vertices were locked at the start, so that no change alters it and no proof of it is
  /// lost.
  std::vector<std::uint8_t> is_fixed;
  /// By vertex: a collapse of it was refuted, and at this tolerance it takes part in no other. Empty: none.
  std::vector<std::uint8_t> refuted;
  std::vector<Quadric> quadrics;  ///< by vertex
  std::vector<float> share;       ///< by vertex: share of the tolerance that samples may reach
  Samples samples;

  double magnitude = 0;  ///< largest coordinate of the original
  double tolerance = 0;
  double tried_tolerance = 0;  ///< all edges have been tried with it, but for those that are open
  double limit = 0;            ///< largest computed distance that proves `tolerance` in real arithmetic
  FeatureLines lines;
  double line_tolerance = HUGE_VAL;  ///< of `lines`, where it is smaller than `tolerance`
  double line_limit = 0;             ///< largest computed distance that proves both tolerances for lines
  bool keeps_positions = false;      ///< vertices may stand only where the original has vertices
  std::optional<LocalTolerance> local;
  std::optional<TextureMap> texture;  ///< set if the texture must not move too far
  std::optional<FaceTurns> turns;     ///< set if faces must not turn too much

  LastChanges last_changes;                     ///< since the last proof
  std::vector<EditLog> logs;                    ///< since the last proof, their numbers ascending
  std::optional<ProvenChanges> proven_changes;  ///< set if changes may have to be taken back once they are proven
  [[nodiscard]] std::uint32_t last_number() const { return logs.empty() ? 0 : logs.back().last_number(); }
  EdgeNotes notes;  ///< deviations are those of `Proposer::deviation`

  /// By vertex: whether edges there may be refused that a change around it opens again.
  std::vector<std::uint8_t> has_refused;

  /// Notes that an edge was refused; until something near changes, it is not worth another try.
  void refuse(Corner corner, float deviation) {
    const Corner edge = mesh.edge(corner);
    notes.refuse(edge, deviation);
    if (!is_far_beyond(deviation)) has_refused[mesh.start(edge)] = has_refused[mesh.end(edge)] = 1;
  }
  void refuse_all();
  /// Whether a vertex has so many faces that no edge there can be collapsed. Where something changes around it, its
  /// edges stay refused until it has lost faces: a cap with n corners would open n edges for each collapse at its rim.
  [[nodiscard]] bool is_hub(std::uint32_t vertex) const {
    constexpr std::size_t removed = 2;
    return mesh.has_more_faces(vertex, max_faces_of_star + removed);
  }
  /// Opens the edges at a vertex that something has changed around, but for those refused far beyond the tolerance.
  void reopen_at(std::uint32_t vertex) {
    if (is_hub(vertex)) return;
    mesh.for_each_edge(vertex, [&](Corner e) { notes.reopen(e); });
  }
  /// Whether the edge was not refused, or something near has changed since that may help.
  [[nodiscard]] bool is_open(Corner corner) const { return !notes.is_refused(mesh.edge(corner)); }
  /// Locks vertices, before any change.
  void lock(std::vector<std::uint8_t> vertices_locked);
  /// Whether a change that is not proven may have altered the face, or it is removed.
  [[nodiscard]] bool is_unproven(std::uint32_t face) const {
    if (is_fixed[face] != 0) return false;
    return mesh.is_removed(face) || last_changes.of_face(mesh, face) != 0;
  }
  [[nodiscard]] bool is_refuted(std::uint32_t vertex) const { return !refuted.empty() && refuted[vertex] != 0; }
  /// Sets a larger tolerance: all proofs hold for it as well, and what was refused may fit now. A smaller one is not
  /// allowed.
  void grow_tolerance(double to);
  /// The largest computed distance that proves `value` in real arithmetic.
  [[nodiscard]] double provable(double value) const;
  /// The largest computed distance around a triangle that proves all tolerances there.
  [[nodiscard]] double limit_around(const TriangleCorners& corners) const;
  [[nodiscard]] double limit_in(const Eigen::AlignedBox3d& box) const {
    return local ? provable(local->sufficient_around(box, tolerance)) : limit;
  }
  /// Makes a triangle of the original part of every result, as it is.
  void keep(std::uint32_t original);
  [[nodiscard]] bool keeps(std::uint32_t original) const { return !is_kept.empty() && is_kept[original] != 0; }
  /// The corners of a triangle of the original.
  [[nodiscard]] TriangleCorners original(std::uint32_t t) const {
    return {vertices[triangles[t][0]], vertices[triangles[t][1]], vertices[triangles[t][2]]};
  }
  /// Whether a triangle of the original is a point or a segment because two of its corners are at one place.
  [[nodiscard]] bool has_equal_corners(std::uint32_t t) const;
  /// Original triangles that are part of every result as they are: no face is near, or shows their part of the texture.
  std::vector<std::uint32_t> kept;
  /// By original triangle: whether it needs no face, as it is in `kept` or others cover it from the start; empty if
  /// none is.
  std::vector<std::uint8_t> is_kept;
  bool starts_as_original = true;      ///< the mesh was the original when the decimation began
  CoverAssignment cover;               ///< which faces each original triangle is proven to be near
  std::vector<std::uint32_t> nearest;  ///< by face: an original triangle near it
};

}  // namespace meshbound
