// SPDX-License-Identifier: MIT
#include "certificate/encoder.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include "certificate/bytes.h"
#include "certificate/checksum.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

enum TokenKind : std::uint64_t { NearToken = 0, CutToken = 1, ParityToken = 2, RecallToken = 3 };

void put_token(Bytes& bytes, TokenKind kind, std::uint64_t payload) { put_variable(bytes, payload << 2 | kind); }

void put_cut(Bytes& bytes, const Chord& chord) {
  const std::uint64_t size_class = chord.bits == 8 ? 0 : chord.bits == 16 ? 1 : chord.bits == 32 ? 2 : 3;
  const std::uint64_t pair = std::uint64_t{chord.to.edge} * (chord.to.edge - 1) / 2 + chord.from.edge;
  put_token(bytes, CutToken, pair << 2 | size_class);
  put(bytes, chord.from.numerator, chord.bits / 8);
  put(bytes, chord.to.numerator, chord.bits / 8);
}

/// The checksum of a mesh: coordinates of all vertices, then corners of all triangles.
class MeshChecksum {
 public:
  void add(const Eigen::Vector3d& vertex) {
    for (int axis = 0; axis < 3; ++axis) add(std::bit_cast<std::uint64_t>(vertex[axis]), 8);
  }
  void add(const Triangle& corners) {
    for (const std::uint32_t vertex : corners) add(vertex, 4);
  }
  [[nodiscard]] std::uint64_t value() const { return crc_.value(); }

 private:
  void add(std::uint64_t word, int size) {
    for (int i = 0; i < size; ++i) crc_.add(static_cast<std::uint8_t>(word >> (8 * i)));
  }
  Crc64 crc_;
};

void put_mesh(Bytes& bytes, const CertifiedMesh& mesh) {
  put(bytes, mesh.vertices, 8);
  put(bytes, mesh.triangles, 8);
  put(bytes, mesh.checksum, 8);
}

/// Appends the sizes of two sections, then what `between` appends, then the bytes of both sections.
template <class Between>
void put_sections(Bytes& bytes, const EncodedSection& forward, const EncodedSection& backward, const Between& between) {
  for (const EncodedSection* section : {&forward, &backward}) {
    put(bytes, section->bytes.size(), 8);
    put(bytes, section->pieces, 8);
  }
  between();
  for (const EncodedSection* section : {&forward, &backward})
    bytes.insert(bytes.end(), section->bytes.begin(), section->bytes.end());
}

void put_lines(Bytes& bytes, const EncodedLines& lines) {
  put(bytes, std::bit_cast<std::uint64_t>(lines.tolerance), 8);
  put(bytes, lines.original.size(), 8);
  put(bytes, lines.simplified.size(), 8);
  put_sections(bytes, lines.original_to_simplified, lines.simplified_to_original, [&] {
    for (const std::span<const Edge> edges : {lines.original, lines.simplified})
      for (const Edge& edge : edges)
        for (const std::uint32_t vertex : edge) put(bytes, vertex, 4);
  });
}

}  // namespace

void SectionEncoder::add(const ProofNode& node) {
  --open_;
  if (node.kind == ProofNode::Kind::Cut) {
    ++result_.cuts;
    put_cut(result_.bytes, node.chord);
    open_ += 2;
  } else {
    add_leaf(node);
  }
  if (open_ == 0)
    for (const std::uint32_t vertex : corners_) last_at_[vertex] = last_;
}

void SectionEncoder::add_leaf(const ProofNode& node) {
  ++result_.pieces;
  const std::uint64_t step = zigzag(static_cast<std::int64_t>(node.target) - static_cast<std::int64_t>(last_));
  last_ = node.target;
  if (node.kind == ProofNode::Kind::Parity) {
    ++result_.by_parity;
    return put_token(result_.bytes, ParityToken, step);
  }
  const auto at = std::find_if(corners_.begin(), corners_.end(),
                               [&](std::uint32_t vertex) { return last_at_[vertex] == node.target; });
  constexpr std::uint64_t max_in_one_byte = 31;
  if (step > max_in_one_byte && at != corners_.end())
    put_token(result_.bytes, RecallToken, static_cast<std::uint64_t>(at - corners_.begin()));
  else
    put_token(result_.bytes, NearToken, step);
}

EncodedSection encode(const MeshView& source, std::span<const std::vector<ProofNode>> trees) {
  SectionEncoder encoder(source.vertex_count());
  std::size_t next = 0;
  for (const std::vector<ProofNode>& run : trees) {
    for (const ProofNode& node : run) {
      if (!encoder.is_open()) encoder.begin(source.triangle(next++));
      encoder.add(node);
    }
  }
  return encoder.take();
}

CertifiedMesh::CertifiedMesh(const MeshView& mesh) : vertices(mesh.vertex_count()), triangles(mesh.triangle_count()) {
  MeshChecksum sum;
  for (std::size_t v = 0; v < mesh.vertex_count(); ++v) sum.add(mesh.vertex(v));
  for (std::size_t t = 0; t < mesh.triangle_count(); ++t) sum.add(mesh.triangle(t));
  checksum = sum.value();
}

CertifiedMesh::CertifiedMesh(const StoredMesh& mesh) : vertices(mesh.vertex_count()), triangles(mesh.triangle_count()) {
  MeshChecksum sum;
  mesh.for_each_vertex([&](std::uint32_t, const Eigen::Vector3d& p) { sum.add(p); });
  mesh.for_each_triangle([&](std::uint32_t, const Triangle& corners) { sum.add(corners); });
  checksum = sum.value();
}

std::vector<std::uint8_t> assemble(const CertifiedMesh& original, const CertifiedMesh& simplified, double tolerance,
                                   const EncodedSection& original_to_simplified,
                                   const EncodedSection& simplified_to_original, const EncodedLines* lines) {
  constexpr std::string_view magic = "MESHCERT";
  const std::uint64_t version = lines == nullptr ? 1 : 2;
  Bytes bytes(magic.begin(), magic.end());
  put(bytes, version, 4);
  put(bytes, 0, 4);
  put(bytes, std::bit_cast<std::uint64_t>(tolerance), 8);
  put_mesh(bytes, original);
  put_mesh(bytes, simplified);
  put_sections(bytes, original_to_simplified, simplified_to_original, [] {});
  if (lines != nullptr) put_lines(bytes, *lines);
  put(bytes, crc64_of(bytes), 8);
  return bytes;
}

Certificate certificate_of(const CertifiedMesh& original, const CertifiedMesh& simplified, double tolerance,
                           const EncodedSection& original_to_simplified, const EncodedSection& simplified_to_original,
                           const EncodedLines* lines) {
  const auto counts_of = [](const EncodedSection& section) {
    return Certificate::Direction{section.pieces, section.by_parity, section.cuts, section.bytes.size()};
  };
  Certificate certificate;
  certificate.original_to_simplified = counts_of(original_to_simplified);
  certificate.simplified_to_original = counts_of(simplified_to_original);
  if (lines != nullptr)
    certificate.lines = {counts_of(lines->original_to_simplified), counts_of(lines->simplified_to_original)};
  certificate.bytes = assemble(original, simplified, tolerance, original_to_simplified, simplified_to_original, lines);
  return certificate;
}

double checked_tolerance(double tolerance) {
  if (!(std::isfinite(tolerance) && tolerance >= 0))
    throw InvalidInput("the tolerance of a certificate must be a length in model units, 0 or more");
  return tolerance + 0.0;  // turns the negative zero into the positive one
}

}  // namespace meshbound
