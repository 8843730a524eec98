// SPDX-License-Identifier: MIT
/// What must hold for any bytes at all. Each function returns when it does and throws `std::logic_error` otherwise, so
/// that libFuzzer sees a crash and a test that replays old findings sees a failure.
#pragma once
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "meshbound/triangle_mesh.h"

namespace meshbound::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Throws `std::logic_error` with the claim unless it holds.
inline void require(bool holds, const std::string& claim) {
  if (!holds) throw std::logic_error(claim);
}

/// A mesh file of this extension (".off") and content is read into a mesh that `validate` accepts, or refused in one
/// line that names the file.
void check_reader(const std::string& extension, Bytes content);

/// The bytes as two soups of a few triangles: every bound and verdict on their distance agrees with exact arithmetic.
void check_distance(Bytes content);

/// The two meshes that `check_certificate` is about, and that its seeds were made for.
struct CertificatePair {
  TriangleMesh original, simplified;
};
[[nodiscard]] CertificatePair certificate_pair();

/// The bytes after the first as a certificate for `certificate_pair`, sealed again for it when the first byte is odd:
/// it is rejected in one line, or what it proves is true of every vertex.
void check_certificate(Bytes content);

/// The bytes as two closed polyhedra with small integer coordinates, under poses: content, parts of the surfaces and
/// depth agree with rational arithmetic.
void check_penetration(Bytes content);

/// The bytes as two small meshes with texture coordinates: every bound on their texture deviation and on the area that
/// is not covered agrees with rational arithmetic.
void check_texture(Bytes content);

/// The bytes as a soup of a few triangles with attributes, and options: every level of its simplification keeps the
/// bounds of its verdict in exact arithmetic, what the options promise of it, and attributes that fit.
void check_simplify(Bytes content);

}  // namespace meshbound::fuzz
