// SPDX-License-Identifier: MIT
/// The proof that a mesh under decimation is within its tolerance of the original, both ways, for what was changed
/// since the last one.
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "meshbound/stop_token.h"
#include "simplify/box_tree.h"
#include "simplify/regions.h"

namespace meshbound {

/// What could not be proven.
struct Unproven {
  std::vector<std::uint32_t> originals;  ///< triangles with a part that no face is near enough to
  std::vector<std::uint32_t> faces;      ///< those that are too far from the original
  [[nodiscard]] bool empty() const { return originals.empty() && faces.empty(); }
};

/// The boxes of all faces of a mesh as it was, to find those near something from scratch.
class FaceBoxes {
 public:
  /// O(n log n).
  explicit FaceBoxes(const ArrayMesh& mesh);
  /// Those that meet `box`.
  void find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const;

 private:
  std::vector<std::uint32_t> faces_;
  std::optional<BoxTree> tree_;
};

/// Scratch memory of the threads that prove, kept from proof to proof.
class ProofWorkers {
 public:
  /// `state` must outlive this.
  ProofWorkers(const DecimationState& state, int threads);
  ~ProofWorkers();

  /// Covers of originals by faces that are there, found by their boxes. False where one has none.
  [[nodiscard]] bool cover_anywhere(std::span<const std::uint32_t> originals, const FaceBoxes& boxes,
                                    std::vector<std::vector<std::uint32_t>>& covers);

 private:
  friend class Proof;
  friend class ChangeProver;
  class Worker;
  std::vector<std::unique_ptr<Worker>> workers_;
};

/// Proves changes one by one, right after they were made to a state that is proven but for them. One for each thread.
class ChangeProver {
 public:
  /// Uses the memory of one thread of `workers`. All must outlive this.
  ChangeProver(DecimationState& state, ProofWorkers& workers, std::size_t thread)
      : state_(state), workers_(workers), thread_(thread) {}
  /// Makes the last change part of what is proven, or takes it back where that fails.
  bool prove_or_undo(const Split& split, Region& region) {
    if (!prove(split, region)) return false;
    accept(region);
    return true;
  }
  /// In two steps: until `accept`, `undo_last` may still take back a change that holds.
  bool prove(const Split& split, Region& region);
  void accept(Region& region);
  /// Makes all changes of the region that are not proven yet, many around one place, part of what is proven. False
  /// where that fails; they are as they were then.
  [[nodiscard]] bool prove_group(const Split& split, Region& region);

  std::uint64_t proven = 0, unproven = 0, originals_tested = 0, faces_tested = 0;

 private:
  DecimationState& state_;
  ProofWorkers& workers_;
  std::size_t thread_;
  std::vector<std::uint32_t> changed_;  ///< by a group
};

/// A proof under way.
///
/// Forward, each original triangle whose cover has lost a face, or never had one, is compared with the faces that its
/// corners were found nearest to, then with those around; pieces of it, where no single face holds it. Backward, each
/// face that was changed is compared with the original. All are independent of each other, so the result is the same
/// for any number of threads.
class Proof {
 public:
  Proof(DecimationState& state, ProofWorkers& workers);

  /// Proves what is still open. Throws `Stopped`; the state is as it was then.
  void run(const StopToken& stop);
  /// What was found not to hold. Empty: all is proven.
  [[nodiscard]] const Unproven& unproven() const { return unproven_; }
  /// These faces, in order, have been changed again, most of them back to what they were: what was proven with them is
  /// open.
  void reopen(const std::vector<std::uint32_t>& changed);
  /// Makes the proof that of the state, which has nothing unproven from then on.
  void commit();

  std::uint64_t originals_tested = 0, faces_tested = 0;

 private:
  void cover_anywhere();
  [[nodiscard]] bool is_stale(std::uint32_t original) const;
  /// The faces that cover the original at a place in `originals_`; none: open.
  [[nodiscard]] std::span<const std::uint32_t> draft(std::uint32_t place) const;

  DecimationState& state_;
  ProofWorkers& workers_;
  std::vector<std::uint32_t> originals_;           ///< to be covered anew; none: not any more
  std::vector<std::uint32_t> only_face_;           ///< by place there: that covers it alone, or none
  std::vector<std::vector<std::uint32_t>> faces_;  ///< by place there: that cover it together
  std::vector<std::uint32_t> open_originals_;      ///< places there
  std::vector<std::uint32_t> open_faces_;
  Unproven unproven_;
};

}  // namespace meshbound
