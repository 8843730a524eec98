// SPDX-License-Identifier: MIT
/// Checks certificates: that the symmetric Hausdorff distance between two meshes is at most a tolerance. Shares no code
/// with the engine that makes them; every decision is exact (numbers.h).
#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "meshbound/attributes.h"
#include "meshbound/triangle_mesh.h"
#include "verify/certificate_reader.h"
#include "verify/texture_check.h"

namespace meshbound::verify {

/// What was proven.
struct Proof {
  double tolerance = 0;  ///< model units
  struct Direction {
    std::uint64_t pieces = 0, by_parity = 0, cuts = 0, bytes = 0;
    std::uint64_t work = 0;             ///< what checking it cost, see `Work`
    std::uint64_t exact_decisions = 0;  ///< distances that intervals of doubles could not decide
  };
  Direction original_to_simplified, simplified_to_original;
  /// What was proven of feature lines.
  struct Lines {
    double tolerance = 0;  ///< of the symmetric Hausdorff distance between them
    std::uint64_t original_edges = 0, simplified_edges = 0;
    bool has_all_borders = false;  ///< every border is a line, see `MeshEdges`, in both meshes
    Direction original_to_simplified, simplified_to_original;
  };
  std::optional<Lines> lines;  ///< absent: the certificate does not speak of lines
  /// What was proven of texture deviation.
  struct Texture {
    double tolerance = 0;  ///< model units
    TextureProof original_to_simplified, simplified_to_original;
  };
  std::optional<Texture> texture;  ///< absent: the certificate does not speak of textures
};

/// Counts, and a checksum of all coordinates and indices in the order of the file. O(n).
[[nodiscard]] MeshIdentity identity_of(const TriangleMesh& mesh);

/// Returns what the certificate proves of these two meshes; throws `Rejected`, with one line that says why, when it
/// proves nothing. O(certificate + meshes): proofs by parity cost the triangles
/// they use, and decisions by rationals the bits of their operands; proofs that need too many of them are refused.
/// Deterministic. Attributes are needed where the certificate speaks of textures; without them it is rejected then.
[[nodiscard]] Proof check_certificate(const TriangleMesh& original, const TriangleMesh& simplified,
                                      std::span<const std::uint8_t> certificate,
                                      const MeshAttributes* original_attributes = nullptr,
                                      const MeshAttributes* simplified_attributes = nullptr);

}  // namespace meshbound::verify
