// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "bvh/bvh_data.h"
#include "distance/search/node_front.h"
#include "proof/cover_record.h"

namespace meshbound {

/// Covers by several triangles that a chunk of a search has found.
struct FoundCovers {
  struct Cover {
    std::uint32_t slot = 0;  ///< of A
    std::uint32_t end = 0;   ///< of its slots in `faces`; they begin where those of the cover before end
    double squared = 0;
  };
  std::vector<Cover> covers;
  std::vector<std::uint32_t> faces;  ///< slots of B

  void add(std::uint32_t slot, const CoverRecord& record) {
    faces.insert(faces.end(), record.slots.begin(), record.slots.end());
    covers.push_back({slot, static_cast<std::uint32_t>(faces.size()), record.squared});
  }
};

/// No point of a triangle of A is further than `bound` from the union of some triangles of B. True for as long as those
/// stay where they are, whatever becomes of the rest of B.
struct TriangleProof {
  double bound = std::numeric_limits<double>::infinity();  ///< model units, rounding included
  std::uint32_t count = 0;                                 ///< of those triangles
  std::uint32_t at = 0;  ///< the slot of the only one, or where their slots begin in `SearchMemory::faces`
};

/// A point of triangle `slot` of A: a + v ab + w ac.
struct StartPoint {
  std::uint32_t slot = 0;
  double v = 0, w = 0;
};

/// What one search leaves for the next one of the same direction. `proofs` and `front` must be true, the rest are
/// hints.
struct SearchMemory {
  bool rigid = false;  ///< true: only the poses of both models change, so a front is kept instead of proofs
  NodeFront front;
  bool names_faces = true;            ///< false: B never changes, so proofs need not say what they rest on
  std::vector<TriangleProof> proofs;  ///< by A's slot
  std::vector<std::uint32_t> faces;   ///< slots of B
  std::vector<std::uint32_t> hints;   ///< by A's vertex: a slot of B near it, or `no_slot`
  std::optional<StartPoint> start;    ///< the furthest point found

  /// Without proofs and without a front, for a model A of that size. `rigid` stays as it is.
  void reset(const Bvh::Data& a);
  /// Replaces the proof of a triangle if the new bound is lower. `used` are slots of B.
  void improve(std::uint32_t slot, double bound, std::span<const std::uint32_t> used);
  void improve(std::uint32_t slot, double bound, std::uint32_t used);
};

}  // namespace meshbound
