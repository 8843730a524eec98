// SPDX-License-Identifier: MIT
/// Turns proofs into the bytes of a certificate (tools/schema/certificate-1.md, certificate-2.md).
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "certificate/proof_node.h"
#include "meshbound/line_mesh.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

/// The proof of one direction: a tree for each source triangle, one after the other.
struct EncodedSection {
  std::vector<std::uint8_t> bytes;
  std::uint64_t pieces = 0, by_parity = 0, cuts = 0;
};

/// `trees` holds the nodes of all source triangles in their order, in any number of runs.
[[nodiscard]] EncodedSection encode(const MeshView& source, std::span<const std::vector<ProofNode>> trees);

/// The proof about feature lines. An edge is a triangle whose last two corners are its second vertex.
struct EncodedLines {
  double tolerance = 0;                        ///< model units
  std::span<const Edge> original, simplified;  ///< by vertices of the meshes
  EncodedSection original_to_simplified, simplified_to_original;
};

/// The file: header, both sections, the lines if there are any (version 2 of the format; else version 1) and the
/// checksum.
[[nodiscard]] std::vector<std::uint8_t> assemble(const MeshView& original, const MeshView& simplified, double tolerance,
                                                 const EncodedSection& original_to_simplified,
                                                 const EncodedSection& simplified_to_original,
                                                 const EncodedLines* lines = nullptr);

}  // namespace meshbound
