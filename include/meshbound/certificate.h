// SPDX-License-Identifier: MIT
#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "meshbound/error.h"
#include "meshbound/line_mesh.h"
#include "meshbound/mesh_view.h"

namespace meshbound {

/// Feature lines that a certificate speaks of as well: the symmetric Hausdorff distance between those of the original
/// and those of the simplified mesh is at most `tolerance`.
struct CertifiedLines {
  std::vector<Edge> original;    ///< edges of triangles of the original, by its vertices; not empty
  std::vector<Edge> simplified;  ///< edges of triangles of the simplified mesh, by its vertices; not empty
  double tolerance = 0;          ///< model units
};

/// How a certificate is made.
struct CertificateOptions {
  int threads = 0;  ///< 0: as many as OpenMP has. The bytes are the same for every value.
  /// Steps of the search for the cuts of one triangle, after which that search ends without a proof.
  std::uint64_t steps_per_triangle = 1'000'000;
  /// Time after which the search ends without a certificate; `InvalidInput` for a negative one and one that is no
  /// number.
  double seconds = std::numeric_limits<double>::infinity();
  const std::atomic<bool>* cancel = nullptr;  ///< set to true from another thread or a signal handler to stop early
  /// Called from the calling thread. May call the library; what it throws ends this call and is passed on.
  std::function<void(double fraction)> progress;
  std::optional<CertifiedLines> lines = {};  ///< absent: the certificate does not speak of lines
};

/// A proof, checkable without any of our code, that the symmetric Hausdorff distance between two meshes is at most a
/// tolerance. The format is documented in tools/schema/certificate-1.md, that of lines in
/// tools/schema/certificate-2.md; `verify_certificate` checks it.
struct Certificate {
  std::vector<std::uint8_t> bytes;  ///< the file, checksum included
  /// What one direction of the proof consists of.
  struct Direction {
    std::uint64_t pieces = 0;     ///< that the triangles were cut into
    std::uint64_t by_parity = 0;  ///< pieces with a parity proof, of which only a seed triangle is stored
    std::uint64_t cuts = 0;       ///< that made the pieces
    std::uint64_t bytes = 0;      ///< of this direction
  };
  Direction original_to_simplified;  ///< every point of the original is near the simplified mesh
  Direction simplified_to_original;  ///< and the reverse
  /// The proof about lines, each of which stands for one triangle without area.
  struct Lines {
    Direction original_to_simplified;  ///< every point of the original's lines is near those of the simplified mesh
    Direction simplified_to_original;  ///< and the reverse
  };
  std::optional<Lines> lines = {};  ///< where `CertificateOptions::lines` are given
};

/// Proves, for any two triangle soups, that each lies within `tolerance` (model units) of the other: vertices and
/// triangles as they are in memory, so a certificate for files needs the meshes as `read_mesh` gives them back.
/// Expected O(n log n) time; O(n) memory. Safe to call from several threads.
///
/// Throws `InvalidInput` for meshes that `validate` refuses, a tolerance that is not finite or negative, lines that are
/// no edges of triangles or of which one of the meshes has none, and meshes whose sizes, or whose distance and a size,
/// differ by more than 2^40 times. Throws `Error`, with one line that names the triangle, when no proof was found: the
/// distance exceeds the tolerance or is closer to it than double arithmetic can tell. Nothing when it was cancelled or
/// ran out of time.
[[nodiscard]] std::optional<Certificate> build_certificate(const MeshView& original, const MeshView& simplified,
                                                           double tolerance, const CertificateOptions& options = {});

}  // namespace meshbound
