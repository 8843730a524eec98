// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace meshbound {

/// Decoders of the bitstreams of version 0 that glTF's extension EXT_meshopt_compression specifies (Khronos, its
/// README, appendices A and B). They return `count` elements of `stride` bytes each, little-endian, or nothing where
/// the stream is malformed, too short or too long for that. No memory is allocated that the length of the stream does
/// not justify. Time is linear in the size of the result.

/// Mode "ATTRIBUTES"; `stride` is a multiple of 4 from 4 to 256.
[[nodiscard]] std::optional<std::string> decode_meshopt_attributes(std::string_view stream, std::size_t count,
                                                                   std::size_t stride);
/// Mode "TRIANGLES": `count` indices, a multiple of 3; `stride` is 2 or 4.
[[nodiscard]] std::optional<std::string> decode_meshopt_triangles(std::string_view stream, std::size_t count,
                                                                  std::size_t stride);
/// Mode "INDICES"; `stride` is 2 or 4.
[[nodiscard]] std::optional<std::string> decode_meshopt_indices(std::string_view stream, std::size_t count,
                                                                std::size_t stride);

/// Filters, applied in place to decoded attributes. Unit vectors: `stride` is 4 or 8.
void apply_octahedral_filter(std::string& elements, std::size_t stride);
/// Unit quaternions of four 16-bit integers.
void apply_quaternion_filter(std::string& elements);
/// Floats, from an exponent of 8 bits and a mantissa of 24 bits.
void apply_exponential_filter(std::string& elements);

}  // namespace meshbound
