// SPDX-License-Identifier: MIT
#include "meshbound/certificate.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "certificate/direction_proof.h"
#include "certificate/encoder.h"
#include "geometry/position_table.h"
#include "mesh/mesh_arrays.h"
#include "meshbound/bvh.h"
#include "meshbound/error.h"
#include "numeric/checked_seconds.h"
#include "numeric/rounding.h"

namespace meshbound {
namespace {

/// Both directions of a proof.
struct Sections {
  EncodedSection forward, backward;
};

/// Whether each corner of each triangle is within the tolerance of the same corner of the triangle with the same number
/// in the other mesh: an original that is written as it is, or rounded to floats. The computed norm of a difference has
/// an error of some units in the last place, which `rounding` covers.
bool corners_correspond(const MeshView& a, const MeshView& b, double tolerance, const StopToken& stop) {
  if (a.triangle_count() != b.triangle_count()) return false;
  constexpr double rounding = 1 + 32 * unit_roundoff;
  constexpr std::size_t triangles_between_looks = std::size_t{1} << 16;
  for (std::size_t t = 0; t < a.triangle_count(); ++t) {
    if (t % triangles_between_looks == 0) stop.check();
    const Triangle corners_a = a.triangle(t), corners_b = b.triangle(t);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d difference = a.vertex(corners_a[k]) - b.vertex(corners_b[k]);
      if (!(next_up(difference.stableNorm() * rounding) <= tolerance) && !difference.isZero(0)) return false;
    }
  }
  return true;
}

/// The proof that each triangle of the source lies near the triangle of the target that has its number.
EncodedSection own_triangles(const MeshView& source) {
  SectionEncoder encoder(source.vertex_count());
  for (std::size_t t = 0; t < source.triangle_count(); ++t) {
    ProofNode near;
    near.target = static_cast<std::uint32_t>(t);
    encoder.begin(source.triangle(t));
    encoder.add(near);
  }
  return encoder.take();
}

/// Nothing if it was cancelled or ran out of time. `element` is what a triangle is called in messages.
std::optional<Sections> prove(const MeshView& original, const MeshView& simplified, double tolerance,
                              const CertificateOptions& options, const StopToken& stop, const char* element) {
  const std::uint64_t triangles = original.triangle_count() + simplified.triangle_count();
  const auto prove_one = [&](const ProofMesh& source, const ProofMesh& target,
                             double progress_from) -> std::optional<EncodedSection> {
    const auto progress = [&](double share) {
      if (options.progress) options.progress(progress_from + 0.5 * share);
    };
    const DirectionProof proof(source, target, tolerance, options, stop, element);
    std::optional<ProofTrees> trees = proof.run(DirectionProof::large_patch, progress);
    if (trees && DirectionProof::costs_too_much(trees->parity_work, triangles))
      trees = proof.run(DirectionProof::small_patch, progress);
    if (!trees) return std::nullopt;
    return encode(source.mesh, trees->runs);
  };
  try {
    validate(original);
    validate(simplified);
    if (corners_correspond(original, simplified, tolerance, stop)) {
      if (options.progress) options.progress(1);
      return Sections{own_triangles(original), own_triangles(simplified)};
    }
    auto forward = prove_one({original, "original"}, {simplified, "simplified"}, 0);
    if (!forward) return std::nullopt;
    auto backward = prove_one({simplified, "simplified"}, {original, "original"}, 0.5);
    if (!backward) return std::nullopt;
    return Sections{std::move(*forward), std::move(*backward)};
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

/// Edges as triangles without area. Throws `InvalidInput` where there are none, or one that no triangle has.
TriangleMesh checked_lines(const MeshView& mesh, std::span<const Edge> edges, const char* name) {
  if (edges.empty()) throw InvalidInput(std::string("the ") + name + " mesh has no lines to certify");
  std::vector<Vec3> positions = positions_of(mesh);
  const std::vector<std::uint8_t> used = used_vertices(mesh);
  for (std::size_t v = 0; v < used.size(); ++v)
    if (used[v] == 0) positions[v] = {};  // may be not finite
  const std::vector<std::uint32_t> first = first_at_position(positions);
  const auto key = [&](std::uint32_t a, std::uint32_t b) { return std::minmax({first[a], first[b]}); };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> known;
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) {
    const Triangle corners = mesh.triangle(t);
    for (std::size_t k = 0; k < 3; ++k) known.push_back(key(corners[k], corners[(k + 1) % 3]));
  }
  std::sort(known.begin(), known.end());
  for (const auto& [a, b] : edges)
    if (a >= first.size() || b >= first.size() || used[a] == 0 || used[b] == 0 ||
        !std::binary_search(known.begin(), known.end(), std::pair<std::uint32_t, std::uint32_t>(key(a, b))))
      throw InvalidInput("the line from vertex " + std::to_string(a) + " to " + std::to_string(b) + " of the " + name +
                         " mesh is no edge of a triangle");
  TriangleMesh vertices;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) vertices.vertices.push_back(mesh.vertex(v));
  return line_mesh(vertices, edges);
}

std::optional<EncodedLines> prove_lines(const MeshView& original, const MeshView& simplified,
                                        const CertifiedLines& lines, CertificateOptions options,
                                        const StopToken& stop) {
  options.progress = {};
  EncodedLines encoded{checked_tolerance(lines.tolerance), lines.original, lines.simplified, {}, {}};
  auto sections =
      prove(checked_lines(original, lines.original, "original"),
            checked_lines(simplified, lines.simplified, "simplified"), encoded.tolerance, options, stop, "line");
  if (!sections) return std::nullopt;
  encoded.original_to_simplified = std::move(sections->forward);
  encoded.simplified_to_original = std::move(sections->backward);
  return encoded;
}

}  // namespace

std::optional<Certificate> build_certificate(const MeshView& original, const MeshView& simplified, double tolerance,
                                             const CertificateOptions& options) {
  tolerance = checked_tolerance(tolerance);
  const StopToken stop =
      StopToken{.cancel = options.cancel}.until(StopToken::Clock::now(), checked_seconds(options.seconds));
  const auto surface = prove(original, simplified, tolerance, options, stop, "triangle");
  if (!surface) return std::nullopt;
  std::optional<EncodedLines> lines;
  if (options.lines) {
    lines = prove_lines(original, simplified, *options.lines, options, stop);
    if (!lines) return std::nullopt;
  }
  return certificate_of(CertifiedMesh(original), CertifiedMesh(simplified), tolerance, surface->forward,
                        surface->backward, lines ? &*lines : nullptr);
}

}  // namespace meshbound
