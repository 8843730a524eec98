// SPDX-License-Identifier: MIT
/// What a fuzzer makes of its bytes.
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <cstring>

#include "fuzz/claims.h"
#include "meshbound/triangle_mesh.h"
#include "reference/hard_meshes.h"

namespace meshbound::fuzz {

/// Takes values off the front; zeros once the bytes have run out.
class Source final : public reference::Choices {
 public:
  explicit Source(Bytes bytes) : bytes_(bytes) {}

  template <class T>
  T take() {
    T value{};
    const std::size_t size = std::min(sizeof value, bytes_.size());
    std::memcpy(&value, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
    return value;
  }

  /// A point with coordinates of the kind that `set_kind` chose.
  Eigen::Vector3d point() override;
  unsigned below(unsigned n) override { return take<std::uint8_t>() % n; }

  /// Any double there is (0), a float (1), a small multiple of 1/8 (2, full of ties), or that at an exponent from
  /// 2^-1016 to 2^1016 (3).
  double coordinate(unsigned kind);
  void set_kind(unsigned kind) { kind_ = kind % 4; }

  /// A mesh with coordinates of this kind. A first byte below 144 gives a soup; any other a shape of `hard_mesh`,
  /// chosen by the next byte, or a variant of `other`, where there is one.
  TriangleMesh mesh(unsigned kind, const TriangleMesh* other = nullptr);

 private:
  /// Up to 8 vertices and 1 to 6 triangles over them, so that neighbours, duplicates and degenerate ones are common.
  TriangleMesh small_soup(unsigned shape);
  TriangleMesh moved_a_little(TriangleMesh mesh);

  Bytes bytes_;
  unsigned kind_ = 0;
};

}  // namespace meshbound::fuzz
