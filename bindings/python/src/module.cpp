// SPDX-License-Identifier: MIT
#include "bind.h"
#include "meshbound/error.h"
#include "meshbound/stop_token.h"

namespace py = pybind11;

namespace {

/// `InvalidInput` is a ValueError and an `Error`, and so on; what is registered later is looked for first.
void bind_errors(py::module_& module) {
  const py::object error = py::register_exception<meshbound::Error>(module, "Error", PyExc_RuntimeError);
  const auto kind_of = [&](PyObject* builtin) { return py::make_tuple(error, py::handle(builtin)); };
  py::register_exception<meshbound::InvalidInput>(module, "InvalidInput", kind_of(PyExc_ValueError));
  py::register_exception<meshbound::Interrupted>(module, "Cancelled", error);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.doc() = "The compiled part of meshbound: arrays in, dictionaries and arrays out.";
  module.attr("__version__") = MESHBOUND_VERSION;
  bind_errors(module);
  meshbound::python::bind_measurement(module);
  meshbound::python::bind_simplification(module);
}
