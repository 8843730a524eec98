// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "simplify/cover/box_tree.h"
#include "simplify/cover/id_list.h"
#include "simplify/decimation_state.h"

namespace meshbound {

/// The boxes of faces of a mesh at the time of construction, to find faces near something without samples.
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

 private:
  template <class IsWanted>
  void take_faces(const ArrayMesh& mesh, const IsWanted& is_wanted);

  static constexpr std::size_t faces_of_changed = 16;  ///< at least, for each changed face

  std::vector<std::uint32_t> faces_;
  std::optional<BoxTree> tree_;
};

/// Scratch memory of the threads that prove, kept from proof to proof.
class ProofWorkers {
 public:
  /// `state` must outlive this.
  ProofWorkers(const DecimationState& state, int threads);
  ~ProofWorkers();

  /// Covers originals by faces found by their boxes. False if one has no cover.
  [[nodiscard]] bool cover_anywhere(std::span<const std::uint32_t> originals, const FaceBoxes& boxes,
                                    std::vector<IdList>& covers);

  class Worker;
  [[nodiscard]] std::size_t count() const { return workers_.size(); }
  [[nodiscard]] Worker& of_thread(std::size_t thread) { return *workers_[thread]; }

 private:
  std::vector<std::unique_ptr<Worker>> workers_;
};

}  // namespace meshbound
