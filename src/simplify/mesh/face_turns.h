// SPDX-License-Identifier: MIT
/// Refuses collapses after which faces of the original would turn too much, by the samples around them.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "simplify/mesh/array_mesh.h"
#include "simplify/mesh/nearest_triangle.h"
#include "simplify/mesh/sample_lists.h"

namespace meshbound {

/// The centroids of the original's faces with their normals, each assigned to the face of the mesh that it was found
/// nearest to. They guide decimation and prove nothing. Threads may change what belongs to faces of different regions
/// at once.
class FaceTurns {
 public:
  struct Sample {
    Vec3 at, normal;  ///< a unit vector
  };

  /// `start` is the original, but for faces that are turned over. Faces without area have no sample. O(n).
  FaceTurns(const ArrayMesh& start, std::vector<std::uint8_t> is_turned_over, double max_degrees);

  [[nodiscard]] const Sample& sample(std::uint32_t s) const { return samples_[s]; }
  /// Assigns the samples of faces that an undone collapse has just restored to the nearest of them.
  void give_back(const ArrayMesh& mesh, std::span<const std::uint32_t> faces);

  /// The unit normal that a face of the mesh has in results, at these corners; 0 where it has no area.
  [[nodiscard]] Vec3 normal(std::uint32_t face, const std::array<Vec3, 3>& corners) const;
  /// Whether two unit normals are within the tolerance of each other.
  [[nodiscard]] bool allows(Vec3 before, Vec3 after) const { return dot(before, after) >= min_cosine_; }

  SampleLists lists;

 private:
  std::vector<std::uint8_t> is_turned_over_;  ///< by face: its corners run the other way than in results
  double min_cosine_;
  std::vector<Sample> samples_;
};

/// Compares the samples around a collapse with the faces as they would be. Each thread needs its own.
class TurnGuard {
 public:
  TurnGuard(const FaceTurns& turns, const ArrayMesh& mesh) : turns_(turns), mesh_(mesh) {}

  /// Starts anew with the faces that stay, by the corner that moves, and those that go. Samples of other faces are
  /// looked at up to a distance of `reach`. O(samples).
  void begin(std::span<const Corner> moved, std::span<const std::uint32_t> removed, double reach);
  /// Whether no sample turns too much with the vertex at `point`: the one of the nearest faces that turns least counts.
  /// Also of samples of the faces around, which one of these faces may then be nearer to than their own. O(samples *
  /// faces), most of which are a look at a box.
  [[nodiscard]] bool holds(Vec3 point);
  /// Assigns the samples to the faces that stay, as `holds` has placed them last.
  void give_samples(FaceTurns& turns);

 private:
  struct Face {
    std::array<Vec3, 3> corners;  ///< the moving one first
    Vec3 normal;
    std::uint32_t number = 0;
  };
  /// A sample of a face around.
  struct Neighbour {
    std::uint32_t sample, face;
    double squared;  ///< distance of the sample from that face, negative where it is not known yet
  };
  [[nodiscard]] bool is_allowed_by_all(const FaceTurns::Sample& sample) const;
  [[nodiscard]] bool turns_little(const FaceTurns::Sample& sample);
  [[nodiscard]] bool stays_or_turns_little(Neighbour& neighbour);
  void find_neighbours();

  const FaceTurns& turns_;
  const ArrayMesh& mesh_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> removed_, samples_, around_;
  std::vector<Corner> moved_;
  double squared_reach_ = 0;
  std::optional<std::vector<Neighbour>> neighbours_;  ///< once they are looked for
  NearestTriangle nearest_;                           ///< of the faces
};

}  // namespace meshbound
