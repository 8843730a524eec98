// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

namespace meshbound {

/// An end of a chord: on the edge of a piece from corner `edge` to the next, at numerator / 2^bits of the way.
struct ChordEnd {
  std::uint32_t edge = 0;
  std::uint64_t numerator = 0;
};

/// Cuts a convex piece into the part with the corners after `from` up to `to`, and the rest. from.edge < to.edge.
struct Chord {
  ChordEnd from, to;
  int bits = 8;  ///< 8, 16, 32 or 48
};

/// A node of the proof that a triangle lies near the other mesh, in preorder (tools/schema/certificate-1.md).
struct ProofNode {
  enum class Kind : std::uint8_t { Near, Cut, Parity };
  Kind kind = Kind::Near;
  std::uint32_t target = 0;  ///< triangle of the other mesh, of Near and Parity
  Chord chord;               ///< of Cut
};

}  // namespace meshbound
