// SPDX-License-Identifier: MIT
/// The parts of the module meshbound._core; each adds its functions.
#pragma once
#include <pybind11/pybind11.h>

namespace meshbound::python {

void bind_measurement(pybind11::module_& module);
void bind_simplification(pybind11::module_& module);

}  // namespace meshbound::python
