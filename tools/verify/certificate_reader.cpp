// SPDX-License-Identifier: MIT
#include "verify/certificate_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "verify/checksum.h"

namespace meshbound::verify {
namespace {

constexpr std::uint64_t version_without_lines = 1, version_with_lines = 2, version_with_texture = 3;
constexpr std::size_t header_size = 104, trailer_size = 8, line_header_size = 56, texture_header_size = 56;

std::uint64_t load(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return value;
}

MeshIdentity identity_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return {load(bytes, at, 8), load(bytes, at + 8, 8), load(bytes, at + 16, 8)};
}

double length_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  const auto length = std::bit_cast<double>(load(bytes, at, 8));
  if (!std::isfinite(length) || std::signbit(length))
    throw Rejected("the tolerance is not a finite length of 0 or more");
  return length;
}

/// Takes the first bytes of `rest` away.
std::span<const std::uint8_t> take(std::span<const std::uint8_t>& rest, std::uint64_t size) {
  if (size > rest.size()) throw Rejected("the sizes in the header do not add up");
  const auto taken = rest.first(size);
  rest = rest.subspan(size);
  return taken;
}

EdgeList take_edges(std::span<const std::uint8_t>& rest, std::uint64_t count) {
  if (count > rest.size()) throw Rejected("the sizes in the header do not add up");  // before a product overflows
  return EdgeList(take(rest, EdgeList::bytes_per_edge * count));
}

LinePart take_lines(std::span<const std::uint8_t>& rest) {
  const auto header = take(rest, line_header_size);
  LinePart lines;
  lines.tolerance = length_at(header, 0);
  lines.original = take_edges(rest, load(header, 8, 8));
  lines.simplified = take_edges(rest, load(header, 16, 8));
  lines.original_to_simplified = {take(rest, load(header, 24, 8)), load(header, 32, 8)};
  lines.simplified_to_original = {take(rest, load(header, 40, 8)), load(header, 48, 8)};
  return lines;
}

TexturePart take_texture(std::span<const std::uint8_t>& rest) {
  const auto header = take(rest, texture_header_size);
  TexturePart texture{length_at(header, 0), load(header, 8, 8), load(header, 16, 8), {}, {}};
  texture.original_to_simplified = {take(rest, load(header, 24, 8)), load(header, 32, 8)};
  texture.simplified_to_original = {take(rest, load(header, 40, 8)), load(header, 48, 8)};
  return texture;
}

}  // namespace

std::array<std::uint32_t, 2> EdgeList::edge(std::size_t i) const {
  return {static_cast<std::uint32_t>(load(bytes_, bytes_per_edge * i, 4)),
          static_cast<std::uint32_t>(load(bytes_, bytes_per_edge * i + 4, 4))};
}

bool speaks_of_texture(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= header_size && load(bytes, 8, 4) == version_with_texture;
}

Certificate parse_certificate(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes.begin()))
    throw Rejected("not a meshbound certificate");
  if (bytes.size() < header_size + trailer_size) throw Rejected("the certificate is truncated");
  const std::uint64_t version = load(bytes, 8, 4);
  if (version < version_without_lines || version > version_with_texture)
    throw Rejected("version " + std::to_string(version) + " of the format is not known here");
  Checksum checksum;
  checksum.add(bytes.first(bytes.size() - trailer_size));
  if (checksum.value() != load(bytes, bytes.size() - trailer_size, 8))
    throw Rejected("the certificate is damaged: its checksum does not fit");
  const std::uint64_t flag = load(bytes, 12, 4);
  if (flag > (version == version_with_texture ? 1U : 0U)) throw Rejected("a reserved field of the header is not 0");

  Certificate certificate;
  certificate.tolerance = length_at(bytes, 16);
  certificate.original = identity_at(bytes, 24);
  certificate.simplified = identity_at(bytes, 48);
  auto rest = bytes.subspan(header_size, bytes.size() - header_size - trailer_size);
  certificate.original_to_simplified = {take(rest, load(bytes, 72, 8)), load(bytes, 80, 8)};
  certificate.simplified_to_original = {take(rest, load(bytes, 88, 8)), load(bytes, 96, 8)};
  if (version == version_with_lines || flag == 1) certificate.lines = take_lines(rest);
  if (version == version_with_texture) certificate.texture = take_texture(rest);
  if (!rest.empty()) throw Rejected("the sizes in the header do not add up");
  return certificate;
}

std::uint64_t TokenReader::little_endian(std::size_t size) {
  if (rest_.size() < size) throw Rejected("the proof ends in the middle of a token");
  const std::uint64_t value = load(rest_, 0, size);
  rest_ = rest_.subspan(size);
  return value;
}

/// LEB128, at most five bytes, no longer than needed.
std::uint64_t TokenReader::variable_length() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 35; shift += 7) {
    const std::uint64_t byte = little_endian(1);
    value |= (byte & 0x7f) << shift;
    if ((byte & 0x80) != 0) continue;
    if (byte == 0 && shift > 0) break;
    return value;
  }
  throw Rejected("a number in the proof is not in its shortest form");
}

Token TokenReader::next() {
  const std::uint64_t word = variable_length();
  const std::uint64_t payload = word >> 2;
  Token token;
  token.kind = static_cast<Token::Kind>(word & 3);
  switch (token.kind) {
    case Token::Kind::Near:
    case Token::Kind::Parity:
      token.step = unfolded(payload);
      break;
    case Token::Kind::Recall:
      if (payload > 2) throw Rejected("a token recalls a corner that a triangle does not have");
      token.corner = static_cast<std::uint32_t>(payload);
      break;
    case Token::Kind::Cut: {
      // Edges (0,1), (0,2), (1,2), (0,3), ... in this order; 1, 2, 4 or 6 bytes for each end.
      constexpr std::size_t bytes_of_end[] = {1, 2, 4, 6};
      const std::size_t size = bytes_of_end[payload & 3];
      std::uint64_t pair = payload >> 2, to = 1;
      for (; pair >= to; ++to) {
        if (to == max_corners) throw Rejected("a chord ends on an edge that no piece has");
        pair -= to;
      }
      if (to >= max_corners) throw Rejected("a chord ends on an edge that no piece has");
      token.bits = static_cast<int>(8 * size);
      token.from = {static_cast<std::uint32_t>(pair), little_endian(size)};
      token.to = {static_cast<std::uint32_t>(to), little_endian(size)};
      break;
    }
  }
  return token;
}

}  // namespace meshbound::verify
