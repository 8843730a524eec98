// SPDX-License-Identifier: MIT
/// Turns proofs into the bytes of a certificate (tools/schema/certificate-1.md, certificate-2.md).
#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "certificate/proof_node.h"
#include "mesh/stored_mesh.h"
#include "meshbound/certificate.h"
#include "meshbound/line_mesh.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

/// The proof of one direction: a tree for each source triangle, one after the other.
struct EncodedSection {
  std::vector<std::uint8_t> bytes;
  std::uint64_t pieces = 0, by_parity = 0, cuts = 0;
};

/// Writes the trees of all source triangles, in their order. A triangle may refer to what its neighbours before it
/// wrote.
class SectionEncoder {
 public:
  explicit SectionEncoder(std::size_t source_vertices) : last_at_(source_vertices, 0) {}

  /// Whether the tree of the triangle that was begun last needs further nodes.
  [[nodiscard]] bool is_open() const { return open_ > 0; }
  void begin(const Triangle& corners) {
    corners_ = corners;
    open_ = 1;
  }
  /// The next node in preorder.
  void add(const ProofNode& node);
  [[nodiscard]] EncodedSection take() { return std::move(result_); }

 private:
  void add_leaf(const ProofNode& node);

  std::vector<std::uint32_t> last_at_;  ///< by vertex: the last target of its triangles so far
  Triangle corners_{};
  std::uint64_t open_ = 0;  ///< nodes that the tree at hand still needs
  std::uint32_t last_ = 0;
  EncodedSection result_;
};

/// `trees` holds the nodes of all source triangles in their order, in any number of runs.
[[nodiscard]] EncodedSection encode(const MeshView& source, std::span<const std::vector<ProofNode>> trees);

/// What a certificate says of a mesh.
struct CertifiedMesh {
  explicit CertifiedMesh(const MeshView& mesh);
  explicit CertifiedMesh(const StoredMesh& mesh);
  std::uint64_t vertices, triangles, checksum;
};

/// The proof about feature lines. An edge is a triangle whose last two corners are its second vertex.
struct EncodedLines {
  double tolerance = 0;                        ///< model units
  std::span<const Edge> original, simplified;  ///< by vertices of the meshes
  EncodedSection original_to_simplified, simplified_to_original;
};

/// The file: header, both sections, the lines if there are any (version 2 of the format; else version 1) and the
/// checksum.
[[nodiscard]] std::vector<std::uint8_t> assemble(const CertifiedMesh& original, const CertifiedMesh& simplified,
                                                 double tolerance, const EncodedSection& original_to_simplified,
                                                 const EncodedSection& simplified_to_original,
                                                 const EncodedLines* lines = nullptr);

/// The file with what it consists of.
[[nodiscard]] Certificate certificate_of(const CertifiedMesh& original, const CertifiedMesh& simplified,
                                         double tolerance, const EncodedSection& original_to_simplified,
                                         const EncodedSection& simplified_to_original,
                                         const EncodedLines* lines = nullptr);

/// Throws `InvalidInput` where no certificate can have this tolerance.
[[nodiscard]] double checked_tolerance(double tolerance);

}  // namespace meshbound
