// SPDX-License-Identifier: MIT
#include <algorithm>
#include <stdexcept>
#include <vector>

#include "fuzz/claims.h"
#include "reference/exact_distance.h"
#include "reference/small_meshes.h"
#include "verify/checksum.h"
#include "verify/verifier.h"

namespace meshbound::fuzz {
namespace {

// Layout of a certificate: tools/schema/certificate-1.md.
constexpr std::size_t header_size = 104, trailer_size = 8;

void put(std::vector<std::uint8_t>& bytes, std::size_t at, std::uint64_t value) {
  for (std::size_t i = 0; i < 8; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (8 * i));
}

void put(std::vector<std::uint8_t>& bytes, std::size_t at, const verify::MeshIdentity& mesh) {
  put(bytes, at, mesh.vertices);
  put(bytes, at + 8, mesh.triangles);
  put(bytes, at + 16, mesh.checksum);
}

/// Makes the header, sizes and checksum of a certificate fit these meshes: only its proof can be a reason to reject it.
void seal(std::vector<std::uint8_t>& bytes, const CertificatePair& pair) {
  if (bytes.size() < header_size + trailer_size) bytes.resize(header_size + trailer_size);
  const std::string_view magic = "MESHCERT";
  std::copy(magic.begin(), magic.end(), bytes.begin());
  put(bytes, 8, 1);
  put(bytes, 24, verify::identity_of(pair.original));
  put(bytes, 48, verify::identity_of(pair.simplified));
  const std::uint64_t body = bytes.size() - header_size - trailer_size;
  const std::uint64_t forward = std::min<std::uint64_t>(bytes[72] + 256U * bytes[73], body);
  put(bytes, 72, forward);
  put(bytes, 88, body - forward);
  verify::Checksum checksum;
  checksum.add(std::span<const std::uint8_t>(bytes).first(bytes.size() - trailer_size));
  put(bytes, bytes.size() - trailer_size, checksum.value());
}

void require_corners_within(const TriangleMesh& from, const TriangleMesh& to, double tolerance) {
  for (const Eigen::Vector3d& corner : from.vertices) {
    if (reference::exact_distance(corner, to).compare(tolerance) > 0)
      throw std::logic_error("a certificate was accepted that is not true");
  }
}

}  // namespace

CertificatePair certificate_pair() {
  TriangleMesh coarse = reference::unit_square(1);
  coarse.vertices[3].z() = 0.25;
  TriangleMesh fine = reference::subdivided(coarse);
  fine.vertices.back().z() += 0.0625;
  return {fine, coarse};
}

void check_certificate(Bytes content) {
  static const CertificatePair pair = certificate_pair();
  if (content.empty()) return;
  std::vector<std::uint8_t> bytes(content.begin() + 1, content.end());
  if (content[0] % 2 != 0) seal(bytes, pair);
  try {
    const double tolerance = verify::check_certificate(pair.original, pair.simplified, bytes).tolerance;
    require_corners_within(pair.original, pair.simplified, tolerance);
    require_corners_within(pair.simplified, pair.original, tolerance);
  } catch (const verify::Rejected& rejected) {
    if (std::string(rejected.what()).find('\n') != std::string::npos)
      throw std::logic_error("the rejection is not one line");
  }
}

}  // namespace meshbound::fuzz
