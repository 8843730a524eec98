// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "geometry/vec3.h"
#include "simplify/cover/box_tree.h"
#include "simplify/mesh/array_mesh.h"

namespace meshbound {

/// The boxes of faces of a mesh at the time of construction, to find faces near something without samples. Faces that
/// have moved since are looked for where they were.
class FaceBoxes {
 public:
  /// Takes the boxes of all faces. O(n log n).
  explicit FaceBoxes(const ArrayMesh& mesh);
  /// Takes the boxes of the faces that meet one of these boxes. Expected O(n log m) for m boxes, and O(k log k) for k
  /// such faces.
  FaceBoxes(const ArrayMesh& mesh, const BoxTree& wanted);
  /// Whether so many of the faces have changed or gone since that boxes should be made anew: they are found where they
  /// were, and what finds them looks at each.
  [[nodiscard]] bool are_outdated(std::size_t changed) const { return changed * faces_of_changed > faces_.size(); }
  /// Appends the faces whose boxes meet `box`.
  void find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const;
  /// As `find`; false if there are more than `max_count` of them, of which it appends some.
  [[nodiscard]] bool find_few(const Eigen::AlignedBox3d& box, std::size_t max_count,
                              std::vector<std::uint32_t>& found) const;

  struct NearFace {
    double squared = 0;  ///< the square of its distance from the point, as computed
    std::uint32_t face = 0;
  };
  /// The faces nearest to a point, the nearest first, of those that the mesh still has and that are within `limit` of
  /// it; at most `max_count`. Around a hub, where boxes of thousands of needles contain the point, they are near ones,
  /// but not always the nearest.
  void find_nearest(const ArrayMesh& mesh, Vec3 point, double limit, std::size_t max_count,
                    std::vector<NearFace>& nearest) const;

 private:
  template <class IsWanted>
  void take_faces(const ArrayMesh& mesh, const IsWanted& is_wanted);

  static constexpr std::size_t faces_of_changed = 16;  ///< at least, for each changed face
  /// Faces that a search for the nearest looks at. With half as many a burst of 5,000 cones keeps 20 more of 29,000
  /// faces.
  static constexpr std::size_t max_looked_at = 2048;

  std::vector<std::uint32_t> faces_;
  std::optional<BoxTree> tree_;
};

}  // namespace meshbound
