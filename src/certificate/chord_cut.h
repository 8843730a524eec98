// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "certificate/proof_node.h"
#include "proof/piece.h"

namespace meshbound {

struct ChordCut {
  Chord chord;
  Piece first, second;
};

/// Cuts a piece along a plane, with the ends of the cut moved to points that few bits describe, by at most `max_shift`
/// (working units) where 48 bits allow it. `sides` are the corners' distances to the plane. Nothing where one side
/// would have no area, or a part would have too many corners. The new corners are those of the certificate, but for
/// `cut_error`.
[[nodiscard]] std::optional<ChordCut> cut_by_chord(const Piece& piece, const CornerDistances& sides, double max_shift);

}  // namespace meshbound
