// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "simplify/cover/forward_cover.h"
#include "simplify/cover/mesh_soup.h"
#include "simplify/cover/surface_walk.h"

namespace meshbound {

/// Covers an original triangle by the faces that are met along its edges. Each edge is walked along once, whichever of
/// its triangles asks first, and most triangles need nothing else: no triangle is cut. Not thread-safe.
///
/// The proof. N(f), all points within the tolerance of face f, is convex. Where a walk passes from f to g it finds a
/// point of the edge in N(f) and in N(g), so the edges are a loop of parts, each in the N of one face and each end of a
/// part in the N of two. The loop is contracted in the plane of the triangle:
/// - A part between two parts of one face may take the straight way between its ends, which is in both N: the three are
///   then parts of that face.
/// - Where the faces of three parts in a row have a vertex of the mesh in common, and that is within the tolerance of a
///   point m of the triangle, m is in all three N. The middle part may go to m and from there to its other end: its two
///   halves are then parts of the faces before and after.
/// Both sweep over points of one N only. Where one face is left, the rest of the loop is in its N, and so is what it
/// surrounds. A loop around a point cannot be contracted without sweeping over it, so each point of the triangle is
/// in the N of one of these faces.
///
/// Where walks begin and pass is a guess. The displacement of rounded points, `cut_error` for each passage, is part of
/// the slack of the proof, as for `ForwardCover`.
class LoopCover {
 public:
  /// Where the walk along an edge begins.
  struct Start {
    std::uint32_t face = no_index;
    bool holds_both = false;  ///< it is known to be within the tolerance of both ends, as `CandidateFaces` tells
  };

  /// Covers triangles of the original that these vertices and triangles make. All three must outlive this.
  LoopCover(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles, PreparedFaces<MeshSoup>& faces)
      : vertices_(vertices), triangles_(triangles), mesh_(faces.soup().mesh), walk_(faces), walks_(walk_count) {}

  /// Forgets all walks. Must be called when the mesh, or what `start_at` and `is_usable` tell, has changed, as must
  /// `PreparedFaces::forget`.
  void forget() {
    ++round_;
    faces_.clear();
  }
  /// Sets the distance within which faces hold points. No coordinate may be larger than `magnitude`.
  void set_tolerance(double tolerance, double magnitude);
  /// Whether a face is within the tolerance of a point; false says nothing.
  [[nodiscard]] bool is_near(std::uint32_t face, Vec3 point) { return walk_.begin(face, point); }
  /// True: `faces` are some that original triangle `t` is near, as `CandidateFaces` tells. `start_at(from, to)` is
  /// where the walk along an edge between two vertices begins, and walks take faces for which `is_usable` is true.
  /// False says nothing, and `faces` are none.
  template <class StartAt, class Usable>
  [[nodiscard]] bool covers(std::uint32_t t, const StartAt& start_at, const Usable& is_usable,
                            std::vector<std::uint32_t>& faces) {
    faces.clear();
    loop_size_ = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = triangles_[t][k], to = triangles_[t][(k + 1) % 3];
      const Walk& walk = walk_between(std::min(from, to), std::max(from, to), start_at, is_usable);
      if (walk.count == 0) return false;
      append(walk, walk.from == from);
    }
    list_faces(faces);
    if (contracts(t)) return true;
    faces.clear();
    return false;
  }

 private:
  /// Most faces along an edge. A needle crosses dozens: with 6 a disc of 60,000 needles takes 30 times as long, as each
  /// that crosses more is cut into hundreds of pieces.
  static constexpr std::size_t max_faces = ForwardCover::deepest_cut;
  /// Edges around a star, so that few walks take the place of others.
  static constexpr std::size_t walk_count = 512;
  /// All walks are forgotten where they have so many faces together: a proof of everything walks along all edges.
  static constexpr std::size_t max_faces_kept = 16 * walk_count;

  /// The faces along an edge.
  struct Walk {
    std::uint32_t low = 0, high = 0;  ///< its vertices by number
    std::uint32_t round = 0;          ///< of `forget`
    std::uint32_t from = 0;           ///< where it begins
    double tolerance = 0;
    std::uint32_t begin = 0, count = 0;  ///< its faces in `faces_`; 0: it does not reach the end
  };
  template <class StartAt, class Usable>
  [[nodiscard]] const Walk& walk_between(std::uint32_t low, std::uint32_t high, const StartAt& start_at,
                                         const Usable& is_usable) {
    Walk& walk = walks_[(7 * low + 3 * high) % walk_count];
    if (walk.round == round_ && walk.low == low && walk.high == high && walk.tolerance == tolerance_) return walk;
    if (faces_.size() > max_faces_kept) forget();
    walk = {low, high, round_, low, tolerance_, static_cast<std::uint32_t>(faces_.size()), 0};
    const Start start = start_at(low, high);
    if (start.holds_both) {
      walk.count = 1;
      faces_.push_back(start.face);
      return walk;
    }
    if (!goes(walk, start, is_usable)) {
      walk.from = high;
      (void)goes(walk, start_at(high, low), is_usable);
    }
    return walk;
  }
  /// Whether the walk reaches the other end. It looks at faces that are not usable before it stops there: as such a
  /// face shares two vertices with one that is usable, no other thread changes it.
  template <class Usable>
  [[nodiscard]] bool goes(Walk& walk, const Start& start, const Usable& is_usable) {
    const Vec3 end = vertices_[walk.from == walk.low ? walk.high : walk.low];
    if (!walk_.begin(start.face, vertices_[walk.from])) return false;
    for (std::uint32_t count = 0; count < max_faces && is_usable(walk_.face());) {
      faces_.push_back(walk_.face());
      ++count;
      if (walk_.reaches(end)) return walk.count = count, true;
      if (!walk_.pass(end)) break;
    }
    faces_.resize(walk.begin);
    return false;
  }

  void append(const Walk& walk, bool forward);
  void append(std::uint32_t face) {
    if (loop_size_ == 0 || loop_[loop_size_ - 1] != face) loop_[loop_size_++] = face;
  }
  void list_faces(std::vector<std::uint32_t>& faces) const;
  [[nodiscard]] bool contracts(std::uint32_t t);
  [[nodiscard]] bool have_near_vertex(const std::array<std::uint32_t, 3>& faces, std::uint32_t t) const;

  const std::vector<Vec3>& vertices_;
  const std::vector<Triangle>& triangles_;
  const ArrayMesh& mesh_;
  SurfaceWalk<MeshSoup> walk_;
  double tolerance_ = 0;
  std::uint32_t round_ = 1;
  std::vector<Walk> walks_;           ///< by a hash of their vertices
  std::vector<std::uint32_t> faces_;  ///< of the walks
  std::size_t loop_size_ = 0;
  std::array<std::uint32_t, 3 * max_faces> loop_{};  ///< the faces of its parts
};

}  // namespace meshbound
