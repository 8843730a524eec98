// SPDX-License-Identifier: MIT
#include <memory>
#include <optional>

#include "bind.h"
#include "buffers.h"
#include "meshbound/certificate.h"
#include "meshbound/distance.h"
#include "meshbound/level_checker.h"
#include "meshbound/mesh_summary.h"
#include "options.h"
#include "results.h"
#include "watched_run.h"

namespace py = pybind11;
using namespace py::literals;

namespace meshbound::python {
namespace {

/// What every measurement can be asked for, each by a keyword argument of the same name.
struct Request {
  std::optional<double> error_bound;
  bool one_sided = false;
  int threads = 0;
  std::optional<double> time_limit;
  py::object progress;
};

/// Throws `InvalidInput` for values that an option cannot have.
Request request_of(const py::dict& given) {
  Request request;
  take(given, "error_bound", "a length", request.error_bound);
  take(given, "one_sided", "True or False", request.one_sided);
  take(given, "threads", "a number of threads", request.threads);
  take(given, "time_limit", "seconds", request.time_limit);
  request.progress = taken_progress(given);
  if (request.error_bound && !(*request.error_bound >= 0))
    throw InvalidInput("the error bound must be a length of 0 or more");
  if (request.time_limit && !(*request.time_limit >= 0)) throw InvalidInput("the time limit must be 0 seconds or more");
  return request;
}

DistanceOptions library_options(const Request& request, Watch& watch) {
  DistanceOptions options;
  options.error_bound = request.error_bound;
  if (request.time_limit) options.budget.seconds = *request.time_limit;
  options.threads = request.threads;
  options.cancel = &watch.cancel;
  options.progress = watch.progress();
  return options;
}

HausdorffDistance only_a_to_b(const OneSidedDistance& direction) {
  HausdorffDistance distance;
  distance.bounds = direction.bounds;
  distance.a_to_b = direction;
  return distance;
}

HausdorffDistance measure(const MeshView& a, const MeshView& b, bool one_sided, const DistanceOptions& options) {
  return one_sided ? only_a_to_b(one_sided_hausdorff_distance(a, b, options)) : hausdorff_distance(a, b, options);
}

ToleranceCheck check(const MeshView& a, const MeshView& b, double tolerance, bool one_sided,
                     const DistanceOptions& options) {
  return one_sided ? check_one_sided_tolerance(a, b, tolerance, options) : check_tolerance(a, b, tolerance, options);
}

/// Calls search(options) as `run_watched` does and returns its answer.
template <class Search>
auto watched(const Request& request, const Search& search) {
  std::optional<decltype(search(DistanceOptions{}))> result;
  run_watched(request.progress, [&](Watch& watch) { result.emplace(search(library_options(request, watch))); });
  return to_dict(*result);
}

py::dict describe(const py::array& vertices, const py::array& triangles) {
  const MeshView mesh = view_of(vertices, triangles);
  MeshSummary summary;
  run_watched(py::none(), [&](Watch&) { summary = summarise(mesh); });
  return py::dict("vertices"_a = summary.vertices, "triangles"_a = summary.faces, "components"_a = summary.components,
                  "closed"_a = summary.closed, "bbox_diagonal"_a = summary.bbox_diagonal);
}

std::unique_ptr<LevelChecker> level_checker(const py::array& vertices, const py::array& triangles,
                                            const py::dict& given) {
  const MeshView original = view_of(vertices, triangles);
  const Request request = request_of(given);
  std::unique_ptr<LevelChecker> checker;
  run_watched(py::none(), [&](Watch& watch) {
    checker = std::make_unique<LevelChecker>(original, BvhOptions{request.threads, {.cancel = &watch.cancel}});
  });
  return checker;
}

py::bytes certificate(const py::array& vertices_a, const py::array& triangles_a, const py::array& vertices_b,
                      const py::array& triangles_b, double tolerance, const py::dict& given) {
  const MeshView a = view_of(vertices_a, triangles_a), b = view_of(vertices_b, triangles_b);
  const Request request = request_of(given);
  std::optional<Certificate> proof;
  run_watched(request.progress, [&](Watch& watch) {
    CertificateOptions options;
    options.threads = request.threads;
    if (request.time_limit) options.seconds = *request.time_limit;
    options.cancel = &watch.cancel;
    options.progress = watch.progress();
    proof = build_certificate(a, b, tolerance, options);
  });
  if (!proof) throw Error("no certificate was found within the time limit");
  return {reinterpret_cast<const char*>(proof->bytes.data()), proof->bytes.size()};
}

}  // namespace

void bind_measurement(py::module_& module) {
  module.def("describe", &describe);
  module.def("certificate", &certificate);
  module.def("measure", [](const py::array& va, const py::array& ta, const py::array& vb, const py::array& tb,
                           const py::dict& given) {
    const MeshView a = view_of(va, ta), b = view_of(vb, tb);
    const Request wanted = request_of(given);
    return watched(wanted, [&](const DistanceOptions& options) { return measure(a, b, wanted.one_sided, options); });
  });
  module.def("check", [](const py::array& va, const py::array& ta, const py::array& vb, const py::array& tb,
                         double tolerance, const py::dict& given) {
    const MeshView a = view_of(va, ta), b = view_of(vb, tb);
    const Request wanted = request_of(given);
    return watched(wanted,
                   [&](const DistanceOptions& options) { return check(a, b, tolerance, wanted.one_sided, options); });
  });
  py::class_<LevelChecker>(module, "LevelChecker")
      .def(py::init(&level_checker))
      .def("check",
           [](LevelChecker& self, const py::array& vertices, const py::array& triangles, double tolerance,
              const py::dict& given) {
             const MeshView level = view_of(vertices, triangles);
             return watched(request_of(given),
                            [&](const DistanceOptions& options) { return self.check(level, tolerance, options); });
           })
      .def("measure", [](LevelChecker& self, const py::array& vertices, const py::array& triangles,
                         const py::dict& given) {
        const MeshView level = view_of(vertices, triangles);
        return watched(request_of(given), [&](const DistanceOptions& options) { return self.measure(level, options); });
      });
}

}  // namespace meshbound::python
