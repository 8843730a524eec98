// SPDX-License-Identifier: MIT
#include "results.h"

#include "meshbound/report.h"

namespace py = pybind11;

namespace meshbound::python {
namespace {

py::tuple to_tuple(const Eigen::Vector3d& p) { return py::make_tuple(p.x(), p.y(), p.z()); }

py::dict to_dict(const Bounds& bounds, const OneSidedDistance& a_to_b, const OneSidedDistance& b_to_a) {
  py::dict result;
  result["lower"] = bounds.lower;
  result["upper"] = bounds.upper;
  result["a_to_b"] = python::to_dict(a_to_b);
  result["b_to_a"] = python::to_dict(b_to_a);
  return result;
}

}  // namespace

py::dict to_dict(const OneSidedDistance& direction) {
  py::dict result;
  result["lower"] = direction.bounds.lower;
  result["upper"] = direction.bounds.upper;
  result["searched"] = was_searched(direction);
  result["outcome"] = was_searched(direction) ? to_string(direction.outcome) : "not_searched";
  result["from_point"] = to_tuple(direction.witness.from.position);
  result["from_triangle"] = direction.witness.from.triangle;
  result["nearest_point"] = to_tuple(direction.witness.nearest.position);
  result["nearest_triangle"] = direction.witness.nearest.triangle;
  return result;
}

py::dict to_dict(const HausdorffDistance& distance) {
  return to_dict(distance.bounds, distance.a_to_b, distance.b_to_a);
}

py::dict to_dict(const ToleranceCheck& check) {
  py::dict result = to_dict(check.bounds, check.a_to_b, check.b_to_a);
  result["verdict"] = to_string(check.verdict);
  result["tolerance"] = check.tolerance;
  return result;
}

}  // namespace meshbound::python
