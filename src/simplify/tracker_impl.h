// SPDX-License-Identifier: MIT
/// What `DeviationTracker` keeps; the members are defined by concept: tracker_start.cpp (faces of the beginning),
/// tracker_examine.cpp (changes), tracker_removal.cpp, and the public face in deviation_tracker.cpp.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "meshbound/deviation_tracker.h"
#include "meshbound/proximity.h"
#include "simplify/box_tree.h"
#include "simplify/cover_assignment.h"
#include "simplify/degree_cover.h"
#include "simplify/forward_cover.h"
#include "simplify/local_deviation.h"
#include "simplify/local_tolerance.h"
#include "simplify/marked_ids.h"
#include "simplify/minimax_placement.h"

namespace meshbound {

/// Corners of a face in our own vectors.
using FaceCorners = std::array<Vec3, 3>;

inline Vec3 to_vec3(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
inline FaceCorners corners_of(const TrackedFace& face) {
  return {to_vec3(face.corners[0]), to_vec3(face.corners[1]), to_vec3(face.corners[2])};
}
inline Eigen::AlignedBox3d box_of(const FaceCorners& corners) {
  Eigen::AlignedBox3d box;
  for (const Vec3 p : corners) box.extend(Eigen::Vector3d(p.x, p.y, p.z));
  return box;
}

struct DeviationTracker::Impl {
  const Bvh& bvh;
  std::vector<Vec3> vertices;
  std::vector<Triangle> triangles;
  Proximity proximity;
  double tolerance = 0;
  double working_tolerance = 0;         ///< what is proven, see `set_tolerance`
  double magnitude = 0;                 ///< largest coordinate seen
  std::optional<LocalTolerance> local;  ///< where triangles have tolerances of their own
  double limit = 0;                     ///< what must be proven for the change under test
  bool covered_with_room = false;       ///< `cover_the_rest` has used a tolerance above 0

  CoverAssignment cover;
  std::vector<FaceCorners> corners;    ///< of current faces, by id
  std::vector<std::uint32_t> nearest;  ///< original triangle near each current face: hint of the backward check

  ForwardCover forward;
  DegreeCover degree;
  LocalDeviation deviation;
  MinimaxPlacement minimax;
  std::vector<FaceCorners> deviation_faces;
  MarkedIds removed_marks, kept_marks, affected_marks;

  /// Where a face is among the candidates of `forward` in the present round.
  struct Candidate {
    std::uint32_t round = 0;
    int index = ForwardCover::no_room;
  };
  std::vector<Candidate> candidates;  ///< by face id
  std::uint32_t candidate_round = 0;
  FaceMask added_bits = 0;
  std::vector<FaceCorners> added_corners;

  std::optional<BoxTree> face_boxes;        ///< at the last `begin_removals`
  std::vector<std::uint32_t> boxed, found;  ///< faces of the boxes; indices of boxes

  struct Pending {
    bool admitted = false;
    std::vector<TrackedFace> added;       ///< those that differ from the current face of their id
    std::vector<std::uint32_t> nearest;   ///< original triangle near each of `added`
    std::vector<std::uint32_t> affected;  ///< original triangles that lost a face
    CoverAssignment::Ids covers;          ///< new covers of `affected`, one after the other
    std::vector<std::size_t> cover_end;   ///< of each of `affected`, in `covers`
  } pending;
  std::vector<FaceMask> used;  ///< candidates that cover each of `pending.affected`, 0: not known yet
  /// A triangle that no single added face holds, and the candidates that it is likely to be held by.
  struct InPieces {
    std::size_t affected;  ///< index in `pending.affected`
    FaceMask likely;
  };
  std::vector<InPieces> in_pieces;
  std::vector<std::uint32_t> ring;
  bool ring_known = false;

  /// What changes of the same faces share, as the placements do that are tried for one edge: the affected originals,
  /// the candidates beyond the added faces, and the corners that none of these holds.
  struct Around {
    bool known = false;
    std::vector<std::uint32_t> removed;  ///< in order
    std::vector<std::uint32_t> added;    ///< ids of those that change
    bool all_change = false;             ///< no face keeps its id and corners
    bool entered = false;                ///< the candidates are those of these faces
    double limit = 0;                    ///< for these candidates
    struct Corner {
      std::uint32_t vertex, triangle;
    };
    std::vector<Corner> left_to_added;  ///< held by no candidate but, perhaps, the added faces
    std::uint32_t near = 0;             ///< original triangle near the moved vertex
  } around;

  Refusal refusal = Refusal::None;
  std::uint32_t uncovered = SurfaceChange::no_triangle;
  TrackerStats stats;

  Impl(const MeshView& original, const Bvh& tree);
  void set_tolerance(double value);
  /// Faces, for samples, and an original triangle near them; with the moved corner first.
  std::uint32_t gather_for_samples(std::span<const std::uint32_t> removed);
  /// Original triangles that the faces stand for, each once.
  [[nodiscard]] std::span<const std::uint32_t> originals_of(std::span<const std::uint32_t> removed);
  void gather_moved(std::span<const TrackedFace> added, std::span<const std::size_t> moved_corner);
  [[nodiscard]] double provable(double value) const;
  [[nodiscard]] double limit_around(const Eigen::AlignedBox3d& box) const;
  [[nodiscard]] double limit_of_change() const;
  void put_face(std::uint32_t id, const FaceCorners& at, std::uint32_t near);

  void select(const SurfaceChange& change);
  void select_faces(const SurfaceChange& change);
  [[nodiscard]] bool is_around(std::span<const std::uint32_t> removed) const;
  void mark_removed(std::span<const std::uint32_t> removed);
  void select_affected(std::span<const std::uint32_t> removed, bool all_change);
  [[nodiscard]] Refusal examine(const SurfaceChange& change);
  [[nodiscard]] bool moved_vertex_near(const SurfaceChange& change);
  [[nodiscard]] std::uint32_t affected_near(Vec3 p) const;
  [[nodiscard]] Refusal cover_affected(const SurfaceChange& change);
  [[nodiscard]] bool is_current(std::uint32_t face) const {
    return !removed_marks.contains(face) || kept_marks.contains(face);
  }
  FaceMask candidate_bit(std::uint32_t face);
  void take_added_corners();
  void enter_added_faces();
  void replace_added_faces();
  [[nodiscard]] bool left_corners_held();
  [[nodiscard]] FaceMask added_of(std::uint32_t t) const;
  FaceMask relied_on(std::uint32_t t);
  [[nodiscard]] bool corner_out_of_reach(std::uint32_t t, FaceMask likely, const SurfaceChange& change);
  [[nodiscard]] bool cover_one(std::size_t i, FaceMask likely, const SurfaceChange& change);
  void append_cover(FaceMask faces);
  void list_covers();
  void find_ring(const SurfaceChange& change);
  [[nodiscard]] bool added_faces_near();
  [[nodiscard]] Refusal examine_removal();
  [[nodiscard]] bool cover_by_others(std::size_t i);
};

}  // namespace meshbound
