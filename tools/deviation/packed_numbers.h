// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <bit>
#include <string>

#include "mesh/data_uri.h"
#include "numeric/byte_order.h"

namespace meshbound::tools {

/// Numbers as a page holds them: base64 of their little-endian bytes, which is what a browser has in its arrays.
class PackedNumbers {
 public:
  template <class Number>
  void add(Number value) {
    std::array<char, sizeof(Number)> raw;
    store_number(value, raw.data(), std::endian::little);
    bytes_.append(raw.data(), raw.size());
  }
  [[nodiscard]] std::string text() const { return encode_base64(bytes_); }

 private:
  std::string bytes_;
};

/// All indices of triangles or edges.
template <class Rows>
[[nodiscard]] std::string packed_indices(const Rows& rows) {
  PackedNumbers numbers;
  for (const auto& row : rows)
    for (const auto index : row) numbers.add(index);
  return numbers.text();
}

}  // namespace meshbound::tools
