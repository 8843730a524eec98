// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// A triangle soup in somebody else's memory: positions as float or double at any stride, indices of 16 or 32 bits.
/// Copies nothing and owns nothing; the buffers must outlive the view. Cheap to copy, safe to read from many threads.
class MeshView {
 public:
  /// A mesh is a view of itself.
  MeshView(const TriangleMesh& mesh);  // NOLINT(google-explicit-constructor)

  /// `stride` is the distance in bytes from one vertex to the next; `indices` holds three per triangle, tightly packed:
  /// 3 `triangle_count` of them. Nothing is looked at here; `validate` checks what the view shows.
  MeshView(const double* positions, std::size_t vertex_count, std::size_t stride, const std::uint32_t* indices,
           std::size_t triangle_count);
  /// @overload
  MeshView(const double* positions, std::size_t vertex_count, std::size_t stride, const std::uint16_t* indices,
           std::size_t triangle_count);
  /// @overload
  MeshView(const float* positions, std::size_t vertex_count, std::size_t stride, const std::uint32_t* indices,
           std::size_t triangle_count);
  /// @overload
  MeshView(const float* positions, std::size_t vertex_count, std::size_t stride, const std::uint16_t* indices,
           std::size_t triangle_count);

  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }      ///< used by a triangle or not
  [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }  ///< degenerate ones included
  [[nodiscard]] Eigen::Vector3d vertex(std::size_t i) const;  ///< i < `vertex_count()`; a float is exact as a double
  [[nodiscard]] Triangle triangle(std::size_t i) const;       ///< i < `triangle_count()`

 private:
  const std::byte* positions_ = nullptr;
  const std::byte* indices_ = nullptr;
  std::size_t vertex_count_ = 0;
  std::size_t triangle_count_ = 0;
  std::size_t stride_ = 0;
  bool single_precision_ = false;
  bool short_indices_ = false;
};

namespace detail {

/// A value at any alignment.
template <class T>
T load(const std::byte* from) {
  T value;
  std::memcpy(&value, from, sizeof(T));
  return value;
}

}  // namespace detail

inline Eigen::Vector3d MeshView::vertex(std::size_t i) const {
  const std::byte* at = positions_ + i * stride_;
  if (!single_precision_)
    return {detail::load<double>(at), detail::load<double>(at + sizeof(double)),
            detail::load<double>(at + 2 * sizeof(double))};
  return {detail::load<float>(at), detail::load<float>(at + sizeof(float)),
          detail::load<float>(at + 2 * sizeof(float))};
}

inline Triangle MeshView::triangle(std::size_t i) const {
  if (!short_indices_) return detail::load<Triangle>(indices_ + i * sizeof(Triangle));
  const auto corners = detail::load<std::array<std::uint16_t, 3>>(indices_ + i * 3 * sizeof(std::uint16_t));
  return {corners[0], corners[1], corners[2]};
}

/// Copies a view into a mesh of its own.
[[nodiscard]] TriangleMesh to_triangle_mesh(const MeshView& view);

/// The largest magnitude a coordinate may have, in model units: 2^1000. Differences and sums of such coordinates
/// cannot overflow, nor can any length computed after the power-of-two scaling of `Frame`.
inline constexpr double largest_coordinate = 0x1p1000;

/// Throws `InvalidInput` unless every vertex that a triangle uses is finite and at most `largest_coordinate` in
/// magnitude, every index is in range, and there is at least one triangle. O(n).
void validate(const MeshView& view);

}  // namespace meshbound
