// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "meshbound/proximity.h"
#include "numeric/marked_ids.h"
#include "numeric/no_index.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/cover/loop_cover.h"
#include "simplify/cover/parity_proof.h"
#include "simplify/cover/patch_cover.h"
#include "simplify/cover/reach_of_triangle.h"
#include "simplify/cover/slab_proof.h"
#include "simplify/cover/sub_triangle_cover.h"
#include "simplify/proof_workers.h"
#include "simplify/regions.h"

namespace meshbound {

/// The scratch memory and the data with which one thread proves single triangles and faces.
class ProofWorkers::Worker {
 public:
  explicit Worker(const DecimationState& state);

  /// Must be called where the mesh may have changed, before `cover` or `cover_anywhere`: what has been prepared of its
  /// faces is kept until then.
  void forget_faces();
  /// Faces that cover an original triangle together; none if no cover was found. Valid until the next call.
  std::span<const std::uint32_t> cover(std::uint32_t t);

  /// As `cover`, with faces found by boxes where the samples do not know which faces are near.
  std::span<const std::uint32_t> cover_anywhere(std::uint32_t t, const FaceBoxes& boxes);

  /// Whether a face is near the original; `near` is an original triangle to start with, and the one found.
  bool is_near(std::uint32_t face, std::uint32_t& near);

  /// Covers of the originals that relied on these faces, which have just been changed, by index below `affected()`.
  /// False where one was not found.
  bool cover_change(std::span<const std::uint32_t> changed, const Split& split, std::uint32_t region);
  [[nodiscard]] std::size_t affected() const { return affected_.size(); }
  /// Where `cover_change` has failed last: a point of the original that is too far from all faces asked. Absent where
  /// it failed for another reason.
  [[nodiscard]] const std::optional<Vec3>& lost_point() const { return lost_point_; }
  /// Whether `cover_change` failed, but might have found a cover with the help of faces of other regions.
  [[nodiscard]] bool meets_seam() const { return meets_seam_; }
  /// Takes over the covers found last.
  void assign_covers(CoverAssignment& cover) const;

  /// As `cover_change` for many faces: each original has candidates of its own, the faces around it.
  bool cover_group(std::span<const std::uint32_t> changed, const Split& split, std::uint32_t region);

 private:
  /// Finds the originals that rely on these faces, cluster by cluster.
  void find_affected(std::span<const std::uint32_t> changed);
  /// The face of the mesh that the sample at an original vertex is assigned to, if any.
  [[nodiscard]] std::uint32_t sample_face(std::uint32_t vertex) const;
  [[nodiscard]] std::size_t end_of_cluster(std::size_t first) const;
  /// Covers the affected originals of a cluster by a single candidate, if one holds the whole cluster.
  bool cover_cluster(std::size_t first, std::size_t end, FaceMask allowed);
  /// Covers affected originals by a candidate each; what has none is to be covered in pieces.
  void cover_one_by_one(std::size_t first, std::size_t end, FaceMask allowed);
  void begin_covers();
  void set_cover(std::size_t i, std::span<const std::uint32_t> faces);
  void set_cover(std::size_t i, FaceMask used);
  /// The faces that a parity proof of an original may use.
  template <class Usable>
  struct UsableFaces {
    MeshSoup all;
    const Usable& is_usable;

    [[nodiscard]] TriangleCorners corners(std::uint32_t face) const { return all.corners(face); }
    [[nodiscard]] std::uint32_t neighbour(std::uint32_t face, std::size_t k) const {
      const std::uint32_t across = all.neighbour(face, k);
      return across == no_index || !is_usable(across) ? no_index : across;
    }
  };
  /// Covers a large original by patches of usable faces, and by the candidates where patches end.
  template <class Usable>
  bool cover_by_patches(const TriangleCorners& corners, double limit, const Usable& is_usable);
  /// A candidate of `added` that holds a vertex of an original, or else one of the faces that have covered the
  /// original. Samples may belong to faces of other regions, which other threads change.
  [[nodiscard]] LoopCover::Start start_of_walk(std::uint32_t t, std::uint32_t from, std::uint32_t to, FaceMask added);
  /// Covers an original by candidates, or by faces around them where many covered it before. `drafted_` are then those
  /// that do so.
  template <class Usable>
  bool cover_by_candidates(std::uint32_t t, double limit, const Usable& is_usable);
  /// Covers an original by faces near those found. `drafted_`, empty before, are then those that do so.
  template <class Usable>
  void cover_by_found(std::uint32_t t, const TriangleCorners& corners, double limit, const Usable& is_usable);
  /// Covers an original by the faces found, which are not more than candidates may be.
  bool cover_by_few(std::uint32_t t, double limit);
  /// Enters the faces around the first `count` of those found.
  template <class Owned>
  void enter_ring(std::size_t count, const Owned& owned);
  /// Enters the faces that have covered the originals in pieces: large ones reach beyond the ring.
  void enter_covers();
  void enter_face(std::uint32_t face);
  /// The face above or below which a point lies, seen along the normals of the faces, or one on the way there. Walks
  /// from `face` across the edge that the point is furthest beyond: a sample that others go with is not always near
  /// theirs.
  [[nodiscard]] std::uint32_t face_under(Vec3 p, std::uint32_t face) const;

  /// A face beside one of these that holds all of an original: around a hub most faces are far from it. `no_index` if
  /// there is none.
  std::uint32_t across(const std::array<std::uint32_t, 3>& faces, const TriangleCorners& corners, double limit);

  /// Like `CandidateFaces::holds`, for faces that are asked for once.
  bool holds(std::uint32_t face, const TriangleCorners& points, double limit);

  /// Covers an original by faces that were changed, or else by faces near those: at a hub these are thousands.
  /// `drafted_` are then those that do so.
  template <class Owned>
  bool cover_among(std::uint32_t t, std::span<const std::uint32_t> changed, const Owned& owned);

  /// Finds the faces that hang together with those at the corners and that meet `reach`. False if they are many: then
  /// it finds some only.
  [[nodiscard]] bool find_around(const std::array<std::uint32_t, 3>& at, const ReachOfTriangle& reach);
  /// Adds the faces that hang together with those found, by faces of which that is true, and that meet `reach`. False
  /// if they are many: then it adds some only.
  template <class Wanted>
  bool spread(const ReachOfTriangle& reach, const Wanted& is_wanted);

  std::span<const std::uint32_t> draft(std::uint32_t face);
  void take(FaceMask used, std::vector<std::uint32_t>& faces) const;

  /// Whether clusters as large as that of an original near a face fit into it: else it has no inner ones.
  [[nodiscard]] bool has_room_for_clusters(const TriangleCorners& face, std::uint32_t near) const;

  const DecimationState& state_;
  ForwardCover cover_;
  OriginalSoup original_;
  std::vector<OriginalClusters::Members> affected_members_;  ///< by cluster of originals, while they are found
  PatchCover patches_, original_patches_;                    ///< of faces, and of originals
  SlabProof slab_proof_;
  std::vector<PatchCover::Part> open_parts_;
  Proximity proximity_;
  PreparedFaces<MeshSoup> prepared_;
  LoopCover loops_;
  SubTriangleCover sub_triangles_;
  MarkedIds found_marks_, vertex_marks_;
  std::vector<std::uint32_t> found_, affected_, affected_clusters_, ids_, drafted_;
  struct Run {
    std::size_t begin = 0, count = 0;
  };
  std::vector<Run> covers_;             ///< by index in `affected_`: its faces in `ids_`
  std::vector<std::size_t> in_pieces_;  ///< indices in `affected_`
  bool meets_seam_ = false;
  std::optional<Vec3> lost_point_;

  /// Clusters are asked for as wholes where a face of a change covers so many originals, two clusters, and where so
  /// many of a cluster count: it has some twelve vertices, each original three.
  static constexpr std::size_t min_originals_of_face = 2 * OriginalClusters::size, min_affected_of_cluster = 6;

  /// The radius of the incircle of a face that is proven by slabs, in square roots of the area of an original: of 16 of
  /// these a cluster has a diameter of 4 at least. A smaller face lies below a hundred originals.
  static constexpr double min_incircle = 4;
  /// The corners of a face may all lie outside a border that runs around it: a strip along one edge and another one cut
  /// them off. What is left open is searched, which takes long where a face is large: with one strip a disc of 10,000
  /// triangles takes twice as long.
  static constexpr int max_strips_of_large = 2;

  /// An original that so many faces covered before needs more cuts than a proof by patches costs.
  static constexpr std::size_t many_faces = 8;

  /// A walk to the face under a point takes one or two steps where the faces are large.
  static constexpr int max_steps = 8;

  /// Faces around an original triangle that are listed, and those that are looked at for the list. Where there are
  /// more, boxes find those that are nearest.
  static constexpr std::size_t max_found = 256, max_looked_at = 4096;
};

}  // namespace meshbound
