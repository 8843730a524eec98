// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "numeric/no_index.h"

namespace meshbound {

/// By triangle of the original: the face that it was at the start, gone or not; `no_index` where it was none.
/// `source_triangle` says of each face at the start which of the `originals` it was. O(n).
[[nodiscard]] inline std::vector<std::uint32_t> faces_of_originals(std::span<const std::uint32_t> source_triangle,
                                                                   std::size_t originals) {
  std::vector<std::uint32_t> face_of(originals, no_index);
  for (std::uint32_t f = 0; f < source_triangle.size(); ++f) face_of[source_triangle[f]] = f;
  return face_of;
}

}  // namespace meshbound
