// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "simplify/cover/parity_proof.h"

namespace meshbound {

/// Covers large original triangles by patches of faces: one parity proof stands for the cuts at all edges of the patch.
///
/// A patch must not end, nor rise too high, above or below the triangle. Where one does, as at the crease that a cap
/// has in common with the wall of a cylinder, a strip along the nearest edge is cut off, and the rest is tried again.
class PatchCover {
 public:
  /// A part of an original triangle.
  struct Part {
    TriangleCorners corners;
    int cuts = 0;  ///< on the way down to it
  };

  /// Appends to `faces` those that cover parts of `whole`, and to `open` the parts that are left: together they are
  /// `whole`, but for the rounding of cut points. `mesh` is a soup as in `ParityProof`, and `likely` are faces of it
  /// that may lie above or below `whole`.
  template <class Soup>
  void cover(const Soup& mesh, const Part& whole, double tolerance, double magnitude,
             std::span<const std::uint32_t> likely, std::vector<std::uint32_t>& faces, std::vector<Part>& open) {
    const auto covers = [&](const TriangleCorners& corners) {
      return parity_.covers_from_first(mesh, corners, tolerance, magnitude, likely);
    };
    if (cut_strips(whole, tolerance, covers, max_tries, open))
      faces.insert(faces.end(), parity_.patch().begin(), parity_.patch().end());
  }
  /// As above, without the faces; `seed_near(corners)` is one that lies above or below the middle of a part, if any
  /// does. So many strips are cut off at most: where they are not enough, `whole` stays open as it is.
  template <class Soup, class SeedNear>
  void cover(const Soup& mesh, const Part& whole, double tolerance, double magnitude, const SeedNear& seed_near,
             int max_strips, std::vector<Part>& open) {
    const auto covers = [&](const TriangleCorners& corners) {
      return parity_.covers(mesh, corners, tolerance, magnitude, seed_near(corners));
    };
    const std::size_t before = open.size();
    if (cut_strips(whole, tolerance, covers, max_strips + 1, open)) return;
    open.resize(before);
    open.push_back(whole);
  }

 private:
  /// Cuts strips off until `covers` holds for the corners of the rest. False where it does not: then the rest is open,
  /// too. The rest keeps away from what stood in the way by the tolerance: an edge at which the soup ends is seldom the
  /// only one there.
  template <class Covers>
  [[nodiscard]] bool cut_strips(const Part& whole, double tolerance, const Covers& covers, int tries,
                                std::vector<Part>& open) {
    Part rest = whole;
    for (; !covers(rest.corners); --tries) {
      const ParityProof::Obstacle obstacle = parity_.obstacle();
      const double share = (obstacle.depth + tolerance) / obstacle.height;
      if (tries == 1 || !(share < max_share)) return open.push_back(rest), false;
      rest = without_strip(rest, obstacle.side, share, open);
    }
    return true;
  }
  /// The part beyond a strip along its edge from corner `side`; the strip goes to `open`.
  [[nodiscard]] static Part without_strip(const Part& part, std::size_t side, double share, std::vector<Part>& open);

  /// A triangle has three edges, and at one that runs along a crease with corners more than one strip may be needed.
  static constexpr int max_tries = 6;
  /// Where strips would take more than this share of the way to the corner across, the part is left as it is.
  static constexpr double max_share = 0.5;

  ParityProof parity_;
};

}  // namespace meshbound
