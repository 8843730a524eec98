// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/sample_lists.h"
#include "simplify/normals/rivals.h"

namespace meshbound {

/// The centroids of the original's faces with their normals, each assigned to the face of the mesh that it was found
/// nearest to. They guide decimation and prove nothing. Threads may change what belongs to faces of different regions
/// at once.
class FaceTurns {
 public:
  struct Sample {
    Vec3 at, normal;  ///< a unit vector
  };
  struct Limits {
    double degrees = 0;  ///< largest turn
    double reach = 0;    ///< how far faces of the original lie apart at most that are watched for being nearer
    int threads = 1;
  };

  /// `start` is the original, but for faces that are turned over. Faces without area have no sample. O(n log n).
  FaceTurns(const ArrayMesh& start, std::vector<std::uint8_t> is_turned_over, const Limits& limits);

  [[nodiscard]] const Sample& sample(std::uint32_t s) const { return samples_[s]; }
  /// The sample that a face had at the start; `no_index` if it had none. O(log n).
  [[nodiscard]] std::uint32_t sample_of_start(std::uint32_t face) const {
    const auto at = std::lower_bound(start_of_.begin(), start_of_.end(), face);
    return at != start_of_.end() && *at == face ? static_cast<std::uint32_t>(at - start_of_.begin()) : no_index;
  }
  /// Calls visit(sample) for all samples of the face.
  template <class Visit>
  void for_each_sample(std::uint32_t face, const Visit& visit) const {
    lists_.for_each(face, visit);
  }
  /// Empties the list of the face: its samples must be given to others.
  void clear(std::uint32_t face) { lists_.clear(face); }
  void give_to(std::uint32_t sample, std::uint32_t face) {
    lists_.give_to(sample, face);
    __atomic_store_n(&face_of_[sample], face, __ATOMIC_RELAXED);
  }
  /// The face of a sample. Where another thread may change it, this is one of the faces of that thread's region.
  [[nodiscard]] std::uint32_t face_of(std::uint32_t sample) const {
    return __atomic_load_n(&face_of_[sample], __ATOMIC_RELAXED);
  }
  /// Assigns the samples of faces that an undone collapse has just restored to the nearest of them.
  void give_back(const ArrayMesh& mesh, std::span<const std::uint32_t> faces);
  /// Faces of the original, by their samples, that are near each other and turn too much from each other.
  [[nodiscard]] const Rivals& rivals() const { return *rivals_; }

  /// The unit normal that a face of the mesh has in results, at these corners; 0 where it has no area.
  [[nodiscard]] Vec3 normal(std::uint32_t face, const TriangleCorners& corners) const;
  /// Whether two unit normals are within the tolerance of each other.
  [[nodiscard]] bool allows(Vec3 before, Vec3 after) const { return dot(before, after) >= min_cosine_; }
  /// The angle between two unit normals in tolerances, rounded.
  [[nodiscard]] float angle(Vec3 before, Vec3 after) const {
    return static_cast<float>(std::acos(std::clamp(dot(before, after), -1.0, 1.0)) / max_angle_);
  }

 private:
  std::vector<std::uint8_t> is_turned_over_;  ///< by face: its corners run the other way than in results
  double max_angle_, min_cosine_;
  std::vector<Sample> samples_;
  SampleLists lists_;
  std::vector<std::uint32_t> face_of_;   ///< by sample
  std::vector<std::uint32_t> start_of_;  ///< by sample: the face that had it at the start, ascending
  std::optional<Rivals> rivals_;
};

}  // namespace meshbound
