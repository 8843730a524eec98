// SPDX-License-Identifier: MIT
/// Reads the bytes of a certificate (tools/schema/certificate-1.md and what follows it). Knows nothing of meshes;
/// whatever the bytes are, it allocates nothing and reads each byte once.
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>

namespace meshbound::verify {

/// Why a certificate proves nothing: one line.
class Rejected : public std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The mesh that a certificate speaks of.
struct MeshIdentity {
  std::uint64_t vertices = 0, triangles = 0, checksum = 0;
  bool operator==(const MeshIdentity&) const = default;
};

/// The proof that one mesh lies near the other: a tree of tokens for each of its triangles.
struct Section {
  std::span<const std::uint8_t> tokens;
  std::uint64_t pieces = 0;
};

/// A list of edges by their two vertices.
class EdgeList {
 public:
  EdgeList() = default;
  explicit EdgeList(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  static constexpr std::size_t bytes_per_edge = 8;
  [[nodiscard]] std::size_t size() const { return bytes_.size() / bytes_per_edge; }
  [[nodiscard]] std::array<std::uint32_t, 2> edge(std::size_t i) const;

 private:
  std::span<const std::uint8_t> bytes_;
};

/// What a certificate says about feature lines.
struct LinePart {
  double tolerance = 0;  ///< model units, finite, not negative
  EdgeList original, simplified;
  Section original_to_simplified, simplified_to_original;
};

/// What a certificate says about textures.
struct TexturePart {
  double tolerance = 0;  ///< model units, finite, not negative
  std::uint64_t original_checksum = 0, simplified_checksum = 0;
  Section original_to_simplified, simplified_to_original;
};

struct Certificate {
  double tolerance = 0;  ///< model units, finite, not negative
  MeshIdentity original, simplified;
  Section original_to_simplified, simplified_to_original;
  std::optional<LinePart> lines;       ///< versions 2 and 3 only
  std::optional<TexturePart> texture;  ///< version 3 only
};

/// What every certificate begins with.
inline constexpr std::string_view magic = "MESHCERT";

/// Whether these bytes claim to be a certificate that speaks of textures, whatever else is wrong with them. O(1).
[[nodiscard]] bool speaks_of_texture(std::span<const std::uint8_t> bytes);

/// Checks magic, version, sizes, tolerance and checksum. The sections point into `bytes`. Throws `Rejected`. O(size).
[[nodiscard]] Certificate parse_certificate(std::span<const std::uint8_t> bytes);

/// One node of a tree, in preorder.
struct Token {
  enum class Kind : std::uint8_t {
    Near,    ///< the piece lies near one triangle of the other mesh
    Cut,     ///< the piece is cut in two along a chord
    Parity,  ///< the piece lies near the other mesh by a parity proof
    Recall   ///< as Near, with the triangle that was last used at a corner of the source triangle
  };
  /// An end of a chord: on the edge from corner `edge` to the next, at the share numerator / 2^bits of the way.
  struct End {
    std::uint32_t edge = 0;
    std::uint64_t numerator = 0;
  };

  Kind kind = Kind::Near;
  std::int64_t step = 0;     ///< Near, Parity: triangle less the one before
  std::uint32_t corner = 0;  ///< Recall
  End from, to;              ///< Cut: from.edge < to.edge < `max_corners`
  int bits = 0;
};

/// Corners that a piece may have. Each cut adds at most one.
inline constexpr std::uint32_t max_corners = 16;

class TokenReader {
 public:
  explicit TokenReader(std::span<const std::uint8_t> tokens) : rest_(tokens) {}
  [[nodiscard]] bool at_end() const { return rest_.empty(); }
  /// Throws `Rejected` when the bytes end early or are none of a token.
  [[nodiscard]] Token next();
  /// A bare number, as proofs about textures consist of. Throws as `next`.
  [[nodiscard]] std::uint64_t number() { return variable_length(); }
  /// The signed number that an unsigned one stands for: 0, -1, 1, -2, 2 ... for 0, 1, 2, 3, 4 ...
  [[nodiscard]] static std::int64_t unfolded(std::uint64_t number) {
    return static_cast<std::int64_t>(number >> 1) ^ -static_cast<std::int64_t>(number & 1);
  }

 private:
  std::uint64_t little_endian(std::size_t size);
  std::uint64_t variable_length();

  std::span<const std::uint8_t> rest_;
};

}  // namespace meshbound::verify
