// SPDX-License-Identifier: MIT
#include "meshbound/texture_certificate.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "certificate/bytes.h"
#include "certificate/checksum.h"
#include "meshbound/error.h"
#include "numeric/checked_seconds.h"
#include "numeric/tasks.h"
#include "numeric/thread_count.h"
#include "texture/charts.h"
#include "texture_proof/texture_search.h"

namespace meshbound {
namespace {

constexpr std::size_t grain = 64;  ///< triangles that a thread takes at once
constexpr std::size_t version_at = 8, lines_flag_at = 12, trailer_size = 8;
constexpr std::uint8_t version_with_texture = 3;

using Trees = std::vector<std::vector<TextureSearch::Node>>;

/// The tree of each triangle of the source, in their order; no node for one without area in the texture where there is
/// no proof. Throws `Stopped`, and `Error` where another triangle has none.
Trees prove(const Charts& source, const Charts& target, const ExactUnits& units, double tolerance, int threads,
            const StopToken& stop, const std::string& name) {
  Trees trees(source.triangles().size());
  std::vector<std::uint8_t> is_proven(trees.size(), 0);
  with_team(thread_count(threads), [&] {
    for_each_range(trees.size(), grain, [&](std::size_t begin, std::size_t end) {
      stop.check();
      TextureSearch search(target, units, tolerance);
      for (std::size_t i = begin; i < end; ++i) {
        is_proven[i] = search.prove(source.triangles()[i], trees[i]) ? 1 : 0;
        if (is_proven[i] == 0 && source.triangles()[i].chart != Chart::Area) {
          trees[i].clear();
          is_proven[i] = 1;
        }
      }
    });
  });
  const auto missing = std::find(is_proven.begin(), is_proven.end(), 0);
  if (missing == is_proven.end()) return trees;
  const auto at = static_cast<std::size_t>(missing - is_proven.begin());
  throw Error("no certificate: the texture of triangle " + std::to_string(source.mesh().triangles[at].triangle) +
              " of the " + name + " mesh moves by more than the tolerance, or its proof needs more pieces than the " +
              "format allows; give a larger --texture-tolerance");
}

/// Before the tree of a triangle without area in the texture: 1, or 0 and no tree. For a node: a number of triangles
/// plus 1 and their indices, each as the difference to the one before; 0 for a cut.
std::pair<Bytes, Certificate::Direction> encoded(const Charts& source, const Trees& trees) {
  Bytes bytes;
  Certificate::Direction counts;
  std::int64_t last = 0;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (source.triangles()[i].chart != Chart::Area) put_variable(bytes, trees[i].empty() ? 0 : 1);
    for (const TextureSearch::Node& node : trees[i]) {
      ++(node.is_cut ? counts.cuts : counts.pieces);
      put_variable(bytes, node.is_cut ? 0 : node.triangles.size() + 1);
      for (const std::uint32_t triangle : node.triangles) {
        put_variable(bytes, zigzag(std::int64_t{triangle} - last));
        last = triangle;
      }
    }
  }
  counts.bytes = bytes.size();
  return {std::move(bytes), counts};
}

/// The checksum of the texture coordinates of all triangles that have them (tools/schema/certificate-3.md).
std::uint64_t checksum_of(const TexturedMesh& mesh) {
  Bytes bytes;
  for (const TexturedTriangle& t : mesh.triangles) {
    put(bytes, t.triangle, 4);
    for (const Eigen::Vector2d& uv : t.coordinates)
      for (const double x : uv) put(bytes, std::bit_cast<std::uint64_t>(x), 8);
  }
  return crc64_of(bytes);
}

void check(const std::array<TexturedMesh, 2>& meshes, double tolerance) {
  if (!(std::isfinite(tolerance) && tolerance >= 0))
    throw InvalidInput("the texture tolerance of a certificate must be a length in model units, 0 or more");
  for (const TexturedMesh& mesh : meshes)
    for (const TexturedTriangle& t : mesh.triangles)
      for (std::size_t k = 0; k < 3; ++k)
        if (!t.corners[k].allFinite() || !t.coordinates[k].allFinite())
          throw InvalidInput("triangle " + std::to_string(t.triangle) +
                             ": a coordinate or texture coordinate is not finite; repair the mesh");
}

/// The file of version 1 or 2 with a part about the texture before its checksum.
Bytes extended(const Bytes& file, const std::array<TexturedMesh, 2>& meshes, double tolerance,
               const std::array<std::pair<Bytes, Certificate::Direction>, 2>& proofs) {
  Bytes bytes(file.begin(), file.end() - trailer_size);
  bytes[lines_flag_at] = bytes[version_at] == 2 ? 1 : 0;
  bytes[version_at] = version_with_texture;
  put(bytes, std::bit_cast<std::uint64_t>(tolerance + 0.0), 8);  // turns the negative zero into the positive one
  for (const TexturedMesh& mesh : meshes) put(bytes, checksum_of(mesh), 8);
  for (const auto& [proof, counts] : proofs) {
    put(bytes, proof.size(), 8);
    put(bytes, counts.pieces, 8);
  }
  for (const auto& [proof, counts] : proofs) bytes.insert(bytes.end(), proof.begin(), proof.end());
  put(bytes, crc64_of(bytes), 8);
  return bytes;
}

}  // namespace

std::optional<TextureCertificate> with_texture_proof(const Certificate& certificate,
                                                     const std::array<TexturedMesh, 2>& meshes, double tolerance,
                                                     const CertificateOptions& options) {
  check(meshes, tolerance);
  const StopToken stop =
      StopToken{.cancel = options.cancel}.until(StopToken::Clock::now(), checked_seconds(options.seconds));
  const Charts original(meshes[0]), simplified(meshes[1]);
  const ExactUnits units = common_units(original, simplified);
  try {
    const std::array proofs = {
        encoded(original, prove(original, simplified, units, tolerance, options.threads, stop, "original")),
        encoded(simplified, prove(simplified, original, units, tolerance, options.threads, stop, "simplified"))};
    TextureCertificate result{certificate, proofs[0].second, proofs[1].second};
    result.certificate.bytes = extended(certificate.bytes, meshes, tolerance, proofs);
    return result;
  } catch (const Stopped&) {
    return std::nullopt;
  }
}

}  // namespace meshbound
