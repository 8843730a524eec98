// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>

#include "verify/certificate_reader.h"
#include "verify/texture_surface.h"

namespace meshbound::verify {

/// What a proof about the texture of one direction consists of.
struct TextureProof {
  std::uint64_t pieces = 0, cuts = 0, bytes = 0;
  double uncovered_share = 0;  ///< of the area of the source: what the target does not cover in the texture; rounded
  double left_out_share = 0;   ///< of that area: triangles without area in the texture that have no proof; rounded
};

/// Checks the proof that each point of the source whose texture coordinate lies inside what the target covers has a
/// point of the target with the same texture coordinate at most the tolerance away. `name` is what messages call the
/// source. Throws `Rejected`. Work beyond what real proofs of this size need is refused. Deterministic.
[[nodiscard]] TextureProof check_texture(const TextureSurface& source, const TextureSurface& target, double tolerance,
                                         const Section& section, const std::string& name);

}  // namespace meshbound::verify
