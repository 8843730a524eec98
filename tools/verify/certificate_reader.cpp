// SPDX-License-Identifier: MIT
#include "verify/certificate_reader.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "verify/checksum.h"

namespace meshbound::verify {
namespace {

constexpr std::uint32_t version = 1;
constexpr std::size_t header_size = 104, trailer_size = 8;

std::uint64_t load(std::span<const std::uint8_t> bytes, std::size_t at, std::size_t size) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < size; ++i) value |= std::uint64_t{bytes[at + i]} << (8 * i);
  return value;
}

MeshIdentity identity_at(std::span<const std::uint8_t> bytes, std::size_t at) {
  return {load(bytes, at, 8), load(bytes, at + 8, 8), load(bytes, at + 16, 8)};
}

}  // namespace

Certificate parse_certificate(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < magic.size() || !std::equal(magic.begin(), magic.end(), bytes.begin()))
    throw Rejected("not a meshbound certificate");
  if (bytes.size() < header_size + trailer_size) throw Rejected("the certificate is truncated");
  if (load(bytes, 8, 4) != version)
    throw Rejected("version " + std::to_string(load(bytes, 8, 4)) + " of the format is not known here");
  Checksum checksum;
  checksum.add(bytes.first(bytes.size() - trailer_size));
  if (checksum.value() != load(bytes, bytes.size() - trailer_size, 8))
    throw Rejected("the certificate is damaged: its checksum does not fit");
  if (load(bytes, 12, 4) != 0) throw Rejected("a reserved field of the header is not 0");

  Certificate certificate;
  certificate.tolerance = std::bit_cast<double>(load(bytes, 16, 8));
  if (!std::isfinite(certificate.tolerance) || std::signbit(certificate.tolerance))
    throw Rejected("the tolerance is not a finite length of 0 or more");
  certificate.original = identity_at(bytes, 24);
  certificate.simplified = identity_at(bytes, 48);
  const std::uint64_t forward = load(bytes, 72, 8), backward = load(bytes, 88, 8);
  const std::size_t body = bytes.size() - header_size - trailer_size;
  if (forward > body || backward != body - forward) throw Rejected("the sizes in the header do not add up");
  const auto tokens = bytes.subspan(header_size, body);
  certificate.original_to_simplified = {tokens.first(forward), load(bytes, 80, 8)};
  certificate.simplified_to_original = {tokens.subspan(forward), load(bytes, 96, 8)};
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
      token.step = static_cast<std::int64_t>(payload >> 1) ^ -static_cast<std::int64_t>(payload & 1);
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
