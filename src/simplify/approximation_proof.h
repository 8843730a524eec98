// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "meshbound/bvh.h"
#include "meshbound/deviation_tracker.h"
#include "meshbound/stop_token.h"
#include "simplify/box_tree.h"
#include "simplify/degree_cover.h"
#include "simplify/unchanged_faces.h"

namespace meshbound {

/// The original, and how near is near enough around a box.
struct ProofOriginal {
  const std::vector<Vec3>& vertices;
  const std::vector<Triangle>& triangles;
  const Bvh& bvh;
  const DegreeCover& degree;
  double magnitude = 0;  ///< largest coordinate
  double tolerance = 0;
  std::function<double(const Eigen::AlignedBox3d&)> limit;  ///< to be proven in doubles; called by several threads
};

/// Proves from nothing that faces are within the tolerance of an original, both ways.
///
/// Triangles that are faces still need no proof. Forward, runs of triangles along the curve of the tree share their
/// candidates, the faces whose boxes come near them. Backward, each face is compared with the original, beginning at a
/// triangle that it was found to hold. Runs and faces are independent of each other, so the result is the same for any
/// number of threads.
class ApproximationProof {
 public:
  /// `original` and `faces` must outlive this. O(faces log faces).
  ApproximationProof(const ProofOriginal& original, std::span<const TrackedFace> faces, int threads,
                     const StopToken& stop);

  /// Throws `Stopped` when the token ended it. Expected O((originals + faces) log faces).
  void run();
  /// Empty when all is proven.
  [[nodiscard]] const Unproven& unproven() const { return unproven_; }

  /// An original triangle near each face, by place in `faces`.
  [[nodiscard]] const std::vector<std::uint32_t>& nearest() const { return nearest_; }
  /// Calls `visit(triangle, ids of the faces that cover it)` for each original triangle.
  template <class Visit>
  void for_each_cover(const Visit& visit) const {
    for (const Covers& run : covers_) {
      std::size_t begin = 0;
      for (std::size_t i = 0; i < run.ends.size(); begin = run.ends[i++])
        visit(run.triangles[i], std::span(run.ids).subspan(begin, run.ends[i] - begin));
    }
  }
  std::uint64_t splits = 0, cuts = 0, faces_by_degree = 0;

 private:
  class ForwardWorker;
  class BackwardWorker;
  /// Of a run of triangles: the ids of the faces of the i-th end at `ends[i]`.
  struct Covers {
    std::vector<std::uint32_t> triangles, ids;
    std::vector<std::size_t> ends;
  };
  template <class Worker>
  void in_parallel(std::size_t items);
  void choose_hints();

  const ProofOriginal& original_;
  std::span<const TrackedFace> faces_;
  int threads_;
  StopToken stop_;
  BoxTree boxes_;
  UnchangedFaces unchanged_;
  std::vector<Covers> covers_;  ///< by run
  std::vector<std::uint32_t> nearest_;
  std::vector<char> is_near_;  ///< by place in `faces_`; several threads write to it
  Unproven unproven_;
};

}  // namespace meshbound
