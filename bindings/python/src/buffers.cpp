// SPDX-License-Identifier: MIT
#include "buffers.h"

#include <string>

#include "meshbound/error.h"

namespace py = pybind11;

namespace meshbound::python {
namespace {

void require_rows_of_three(const py::array& array, const char* name) {
  if (array.ndim() != 2 || array.shape(1) != 3)
    throw InvalidInput(std::string(name) + " must be an array of shape (n, 3)");
  const bool is_together = array.strides(1) == array.itemsize();
  if (array.shape(0) > 1 && (!is_together || array.strides(0) < 3 * array.itemsize()))
    throw InvalidInput(std::string(name) + " must have its rows one after the other");
}

template <class Coordinate, class Index>
MeshView typed_view(const py::array& vertices, const py::array& triangles) {
  const auto stride = static_cast<std::size_t>(vertices.shape(0) > 1 ? vertices.strides(0) : 3 * vertices.itemsize());
  return {static_cast<const Coordinate*>(vertices.data()), static_cast<std::size_t>(vertices.shape(0)), stride,
          static_cast<const Index*>(triangles.data()), static_cast<std::size_t>(triangles.shape(0))};
}

template <class Coordinate>
MeshView view_with(const py::array& vertices, const py::array& triangles) {
  if (py::isinstance<py::array_t<std::uint32_t>>(triangles))
    return typed_view<Coordinate, std::uint32_t>(vertices, triangles);
  if (py::isinstance<py::array_t<std::int32_t>>(triangles))
    return typed_view<Coordinate, std::int32_t>(vertices, triangles);
  if (py::isinstance<py::array_t<std::uint16_t>>(triangles))
    return typed_view<Coordinate, std::uint16_t>(vertices, triangles);
  throw InvalidInput("triangles must be of type uint16, int32 or uint32");
}

}  // namespace

MeshView view_of(const py::array& vertices, const py::array& triangles) {
  require_rows_of_three(vertices, "vertices");
  require_rows_of_three(triangles, "triangles");
  if (triangles.shape(0) > 1 && triangles.strides(0) != 3 * triangles.itemsize())
    throw InvalidInput("triangles must be packed");
  const bool is_single = py::isinstance<py::array_t<float>>(vertices);
  if (!is_single && !py::isinstance<py::array_t<double>>(vertices))
    throw InvalidInput("vertices must be of type float32 or float64");
  const MeshView view = is_single ? view_with<float>(vertices, triangles) : view_with<double>(vertices, triangles);
  validate(view);
  return view;
}

py::array_t<double> to_array(std::vector<Eigen::Vector3d>&& points) {
  const double* first = points.empty() ? nullptr : points.front().data();
  const auto rows = static_cast<py::ssize_t>(points.size());
  return owning_array(std::move(points), first, {rows, 3});
}

py::array_t<std::uint32_t> to_array(std::vector<std::uint32_t>&& values) {
  const std::uint32_t* first = values.data();
  const auto size = static_cast<py::ssize_t>(values.size());
  return owning_array(std::move(values), first, {size});
}

}  // namespace meshbound::python
