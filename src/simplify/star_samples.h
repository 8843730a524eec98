// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "bvh/build_kernels.h"
#include "meshbound/proximity.h"
#include "simplify/cover/original_soup.h"
#include "simplify/cover/surface_walk.h"
#include "simplify/decimation_state.h"
#include "simplify/kernel/kernels.h"

namespace meshbound {

/// The samples of a few faces, compared with the faces that a change would replace them by. One for each thread.
class StarSamples {
 public:
  /// `max_originals` are kept prepared for walks, a power of two.
  explicit StarSamples(DecimationState& state, std::size_t max_originals = PreparedFaces<OriginalSoup>::few)
      : state_(state),
        proximity_(state.tree),
        originals_(OriginalSoup{state.vertices, state.triangles, state.neighbours}, max_originals),
        walk_(originals_) {}

  /// Starts anew, without samples. `points` are relative to `origin`, a point nearby.
  void begin(Vec3 origin);
  void add_face(std::uint32_t face) { add_faces({&face, 1}); }
  void add_faces(std::span<const std::uint32_t> faces);
  /// Adds a point of the original that is no sample, until the next star.
  void add_point(Vec3 point) { points_.add(point - origin_); }
  [[nodiscard]] bool empty() const { return ids_.empty(); }
  [[nodiscard]] const SamplePoints& points() const { return points_; }

  /// Takes the changed faces that samples are compared with, in coordinates relative to the origin. They must stay
  /// where they are until others are taken.
  void compare(std::span<const SampleFace> faces);
  [[nodiscard]] std::span<const SampleOffsets> offsets();
  /// Whether each sample is within `limit` of one of these faces, or of a face beside them.
  [[nodiscard]] bool hold(std::span<const std::uint32_t> beside, double limit);
  /// Whether a vertex of the changed faces is within `limit` of the original.
  [[nodiscard]] bool is_near_original(Vec3 point, double limit);
  /// Looks along the edge from that vertex to `end`, by a walk over the original or at `points` points in equal steps.
  /// Returns the share of the way to a point that is not within `limit` of the original; absent if none was seen.
  [[nodiscard]] std::optional<double> stray_on_edge(Vec3 vertex, Vec3 end, int points, double limit);
  /// Whether nothing is seen to be too far from the original by a look at a vertex of the mesh, by a walk from there to
  /// `end`, and beyond where the walk leads at those of `points` points in equal steps. `near` is an original triangle
  /// to start with, and one near the vertex then. No star is needed.
  [[nodiscard]] bool is_edge_near(Vec3 vertex, Vec3 end, std::uint32_t& near, int points, double limit);
  /// Where an edge passes from one original to the next below.
  struct Crossing {
    Vec3 point;
    std::uint32_t near = 0;  ///< the next original
    double squared = 0;      ///< distance from both
  };
  /// How far a walk over the original below an edge has come.
  struct Walked {
    double share = 0;        ///< of the way: 1 at the end
    std::uint32_t near = 0;  ///< the original that it has reached
    std::optional<Crossing> farthest;
  };
  /// Walks from a vertex near original `near` to `end`, as long as the edge is within two tolerances of the original.
  /// Between two crossings an edge is nearer to the original than at the farther one, or at an end of it. Ends after
  /// `max_passes` originals. No star is needed.
  [[nodiscard]] Walked walk_below(Vec3 vertex, Vec3 end, std::uint32_t near, int max_passes);
  /// The vector from the closest point of the original to `point`.
  [[nodiscard]] Vec3 offset_from_original(Vec3 point);
  /// Assigns each sample to the face that `hold` found nearest to it. `numbers` are those of the changed faces; the
  /// lists of the faces whose samples were added must have been cleared.
  void give(std::span<const std::uint32_t> numbers);
  /// As `give`, without `hold`: to the nearest of the changed faces, however far it is.
  void give_to_nearest(std::span<const std::uint32_t> numbers);

 private:
  [[nodiscard]] std::optional<double> stray_beyond(Vec3 vertex, Vec3 end, const Walked& walked, int points,
                                                   double limit);
  [[nodiscard]] bool is_near(Vec3 point, std::uint32_t& near, double limit);
  void compare_blocks(std::size_t end);
  [[nodiscard]] std::uint32_t triangle_near(Vec3 point) const;
  [[nodiscard]] std::uint32_t face_beside(std::size_t i, std::span<const std::uint32_t> beside,
                                          float squared_limit) const;
  [[nodiscard]] std::size_t nearest(std::size_t i) const;
  void sort_along_curve();
  void thin_out(std::span<const std::uint32_t> numbers);

  DecimationState& state_;
  Proximity proximity_;
  PreparedFaces<OriginalSoup> originals_;
  SurfaceWalk<OriginalSoup> walk_;
  SampleKernel kernel_ = simplify_kernels().samples;
  BuildKernels build_kernels_ = build_kernels();
  std::uint32_t near_ = 0;  ///< original triangle near that vertex
  Vec3 origin_;
  std::vector<std::uint32_t> next_;  ///< samples of each face that is being added
  std::vector<std::uint32_t> ids_;   ///< by point, as far as it is a sample
  SamplePoints points_;              ///< samples, then points that are none
  std::span<const SampleFace> faces_;
  std::size_t compared_ = 0;                                    ///< blocks whose offsets are known
  std::vector<SampleOffsets> offsets_;                          ///< of the points from the changed faces
  std::vector<std::pair<std::size_t, std::uint32_t>> outside_;  ///< points that only a face beside is near
  std::vector<std::uint64_t> order_;  ///< places along a curve, in the lower bits the points there
  std::vector<std::uint64_t> scratch_;
};

}  // namespace meshbound
