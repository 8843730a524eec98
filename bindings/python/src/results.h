// SPDX-License-Identifier: MIT
/// Results as dictionaries, from which the Python side makes its dataclasses.
#pragma once
#include <pybind11/pybind11.h>

#include "meshbound/distance.h"

namespace meshbound::python {

/// Keys: lower, upper, searched, outcome, from_point, from_triangle, nearest_point, nearest_triangle.
[[nodiscard]] pybind11::dict to_dict(const OneSidedDistance& direction);
/// Keys: lower, upper, a_to_b, b_to_a.
[[nodiscard]] pybind11::dict to_dict(const HausdorffDistance& distance);
/// As of a distance, with verdict and tolerance besides.
[[nodiscard]] pybind11::dict to_dict(const ToleranceCheck& check);

}  // namespace meshbound::python
