// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <optional>

#include "meshbound/certificate.h"
#include "meshbound/texture_deviation.h"

namespace meshbound {

/// A certificate that speaks of texture deviation as well.
struct TextureCertificate {
  Certificate certificate;                        ///< version 3 of the format, tools/schema/certificate-3.md
  Certificate::Direction original_to_simplified;  ///< the proof about the texture of the original
  Certificate::Direction simplified_to_original;  ///< and the reverse
};

/// Adds to a certificate the proof that texture deviation (meshbound/texture_deviation.h) is at most `tolerance`, in
/// model units: each point of one mesh whose texture coordinate lies inside what triangles of the other mesh cover in
/// the texture has a point of the other mesh with the same texture coordinate at most that far away, and the other way
/// round. What the other mesh does not cover is shown not to be covered.
///
/// `certificate` is one of `build_certificate` for the original and the simplified mesh, which `meshes` are as
/// `textured_meshes` gives them. Of `options`, lines and progress are not used. Deterministic. Expected
/// O((n + k) log n) for k pairs of triangles that meet in the texture. Safe to call from several threads.
///
/// Throws `InvalidInput` for a tolerance that is not finite or negative and for coordinates that are not finite;
/// `Error`, with one line that names the triangle, when no proof was found. Nothing when it was cancelled or ran out of
/// time.
[[nodiscard]] std::optional<TextureCertificate> with_texture_proof(const Certificate& certificate,
                                                                   const std::array<TexturedMesh, 2>& meshes,
                                                                   double tolerance,
                                                                   const CertificateOptions& options = {});

}  // namespace meshbound
