// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <ranges>
#include <span>

#include "meshbound/error.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

template <class T>
concept CoordinateType = std::same_as<T, float> || std::same_as<T, double>;

template <class T>
concept IndexType = std::same_as<T, std::uint16_t> || std::same_as<T, std::uint32_t> || std::same_as<T, std::int32_t>;

/// A triangle soup in buffers of the caller: positions as float or double at any stride, indices of 16 or 32 bits, or
/// `int`. Copies nothing and owns nothing; the buffers must outlive the view. Cheap to copy, safe to read from many
/// threads. Indices are checked by `validate`, which every function of the library calls on what it is given.
class MeshView {
 public:
  /// A mesh is a view of itself.
  MeshView(const TriangleMesh& mesh);  // NOLINT(google-explicit-constructor)

  /// `positions` holds x, y, z of each vertex, `indices` three vertices of each triangle; both are tightly packed
  /// contiguous ranges, such as std::vector, std::array or std::span. Throws `InvalidInput` when one of the sizes is
  /// not a multiple of three.
  template <std::ranges::contiguous_range Positions, std::ranges::contiguous_range Indices>
  requires CoordinateType<std::ranges::range_value_t<Positions>> && IndexType<std::ranges::range_value_t<Indices>>
  MeshView(const Positions& positions, const Indices& indices)
      : MeshView(std::ranges::data(positions), triples(std::ranges::size(positions), "coordinates"),
                 3 * sizeof(std::ranges::range_value_t<Positions>), indices) {}

  /// Positions inside larger vertices: `stride` is the distance in bytes from one vertex to the next. Throws as above
  /// when the number of indices is not a multiple of three.
  template <CoordinateType Coordinate, std::ranges::contiguous_range Indices>
  requires IndexType<std::ranges::range_value_t<Indices>> MeshView(const Coordinate* positions,
                                                                   std::size_t vertex_count, std::size_t stride,
                                                                   const Indices& indices)
      : MeshView(positions, vertex_count, stride, std::ranges::data(indices),
                 triples(std::ranges::size(indices), "indices")) {}

  /// From bare pointers. The last argument is the number of triangles, not of indices; nothing can check it.
  template <CoordinateType Coordinate, IndexType Index>
  MeshView(const Coordinate* positions, std::size_t vertex_count, std::size_t stride, const Index* indices,
           std::size_t triangle_count)
      : positions_(reinterpret_cast<const std::byte*>(positions)),
        indices_(reinterpret_cast<const std::byte*>(indices)),
        vertex_count_(vertex_count),
        triangle_count_(triangle_count),
        stride_(stride),
        single_precision_(std::same_as<Coordinate, float>),
        short_indices_(std::same_as<Index, std::uint16_t>) {}

  [[nodiscard]] std::size_t vertex_count() const { return vertex_count_; }      ///< used by a triangle or not
  [[nodiscard]] std::size_t triangle_count() const { return triangle_count_; }  ///< degenerate ones included
  [[nodiscard]] Eigen::Vector3d vertex(std::size_t i) const;  ///< i < `vertex_count()`; a float is exact as a double
  [[nodiscard]] Triangle triangle(std::size_t i) const;       ///< i < `triangle_count()`
  /// Asks the processor to fetch what `vertex(i)` will read. Does nothing where the compiler has no word for that.
  void prefetch_vertex(std::size_t i) const;    ///< i < `vertex_count()`
  void prefetch_triangle(std::size_t i) const;  ///< the same for `triangle(i)`, i < `triangle_count()`

 private:
  /// A third of `size`; throws `InvalidInput`, naming `what`, when that is no whole number.
  static std::size_t triples(std::size_t size, const char* what);

  const std::byte* positions_ = nullptr;
  const std::byte* indices_ = nullptr;
  std::size_t vertex_count_ = 0;
  std::size_t triangle_count_ = 0;
  std::size_t stride_ = 0;
  bool single_precision_ = false;
  bool short_indices_ = false;
};

namespace detail {

inline void prefetch([[maybe_unused]] const std::byte* from) {
#if defined(__GNUC__)
  __builtin_prefetch(from);
#endif
}

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
  return {static_cast<double>(detail::load<float>(at)), static_cast<double>(detail::load<float>(at + sizeof(float))),
          static_cast<double>(detail::load<float>(at + 2 * sizeof(float)))};
}

inline Triangle MeshView::triangle(std::size_t i) const {
  if (!short_indices_) return detail::load<Triangle>(indices_ + i * sizeof(Triangle));
  const auto corners = detail::load<std::array<std::uint16_t, 3>>(indices_ + i * 3 * sizeof(std::uint16_t));
  return {corners[0], corners[1], corners[2]};
}

inline void MeshView::prefetch_vertex(std::size_t i) const { detail::prefetch(positions_ + i * stride_); }
inline void MeshView::prefetch_triangle(std::size_t i) const {
  detail::prefetch(indices_ + i * 3 * (short_indices_ ? sizeof(std::uint16_t) : sizeof(std::uint32_t)));
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
