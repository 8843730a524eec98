// SPDX-License-Identifier: MIT
/// Arrays of numpy as meshes of the library, and the other way round; neither copies.
#pragma once
#include <pybind11/numpy.h>

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "meshbound/mesh_view.h"

namespace meshbound::python {

/// A view of the arrays, which must stay alive and unchanged while it is used. `vertices` is (n, 3), float32 or
/// float64, with the coordinates of a vertex beside each other; `triangles` is (m, 3), packed, uint16, int32 or uint32.
/// Throws `InvalidInput` for other arrays, and as `validate`.
[[nodiscard]] MeshView view_of(const pybind11::array& vertices, const pybind11::array& triangles);

/// An array of that shape that owns the values, which `first` points to.
template <class Value, class Values>
pybind11::array_t<Value> owning_array(Values&& values, const Value* first, std::vector<pybind11::ssize_t> shape) {
  auto owner = std::make_unique<std::remove_cvref_t<Values>>(std::forward<Values>(values));  // moving keeps the values
  pybind11::capsule capsule(owner.get(), [](void* p) { delete static_cast<std::remove_cvref_t<Values>*>(p); });
  (void)owner.release();
  return pybind11::array_t<Value>(std::move(shape), first, capsule);
}

/// Positions as an (n, 3) array of doubles.
[[nodiscard]] pybind11::array_t<double> to_array(std::vector<Eigen::Vector3d>&& points);
/// Index tuples as an (n, 3) or (n, 2) array.
template <std::size_t Size>
[[nodiscard]] pybind11::array_t<std::uint32_t> to_array(std::vector<std::array<std::uint32_t, Size>>&& tuples) {
  const auto* first = tuples.empty() ? nullptr : tuples.front().data();
  const auto rows = static_cast<pybind11::ssize_t>(tuples.size());
  return owning_array(std::move(tuples), first, {rows, static_cast<pybind11::ssize_t>(Size)});
}
/// Numbers as an array of one dimension.
[[nodiscard]] pybind11::array_t<std::uint32_t> to_array(std::vector<std::uint32_t>&& values);

}  // namespace meshbound::python
