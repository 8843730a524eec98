// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include "bind.h"
#include "buffers.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"
#include "options.h"
#include "results.h"
#include "watched_run.h"

namespace py = pybind11;

namespace meshbound::python {
namespace {

SimplifyOptions library_options(const py::dict& given) {
  SimplifyOptions options;
  take(given, "tolerance", "a length", options.tolerance);
  take(given, "levels", "lengths", options.levels);
  take(given, "target_faces", "a whole number, 0 or more", options.target_faces);
  take(given, "target_ratio", "a share, 0 to 1", options.target_ratio);
  take(given, "prune", "True or False", options.prune);
  take(given, "preserve_boundary", "True or False", options.preserve_boundary);
  take(given, "keep_sides", "True or False", options.keep_sides);
  take(given, "locked_vertices", "True or False for each vertex", options.locked_vertices);
  take(given, "feature_angle", "an angle in radians", options.feature_angle);
  take(given, "line_tolerance", "a length", options.line_tolerance);
  take(given, "feature_edges", "pairs of indices of vertices", options.feature_edges);
  take(given, "face_tolerances", "a length for each triangle", options.face_tolerances);
  take(given, "certificate", "True or False", options.certificate);
  take(given, "time_limit", "seconds", options.time_limit);
  take(given, "threads", "a number of threads", options.threads);
  static_assert(static_cast<int>(OnExceed::Stop) == 1 && static_cast<int>(Effort::High) == 1 &&
                static_cast<int>(CollapsePlacements::Subset) == 1 && static_cast<int>(Precision::Single) == 1);
  take_word(given, "on_exceed", "skip", "stop", options.on_exceed);
  take_word(given, "effort", "normal", "high", options.effort);
  take_word(given, "placement", "optimal", "subset", options.placements);
  take_word(given, "precision", "double", "single", options.precision);
  return options;
}

py::dict to_dict(SimplifiedLevel& level) {
  py::dict result;
  result["tolerance"] = level.tolerance;
  result["verdict"] = to_string(level.verdict);
  result["ended_by"] = to_string(level.ended_by);
  result["distance"] = python::to_dict(level.distance.value());
  result["line_distance"] = py::none();
  if (level.line_distance) result["line_distance"] = python::to_dict(*level.line_distance);
  result["lines"] = to_array(std::move(level.lines));
  result["vertices"] = to_array(std::move(level.mesh.vertices));
  result["triangles"] = to_array(std::move(level.mesh.triangles));
  result["source_vertices"] = to_array(std::move(level.source_vertex));
  result["source_triangles"] = to_array(std::move(level.source_triangle));
  result["turned_faces"] = level.turned_faces;
  result["certificate"] = py::none();
  if (level.certificate)
    result["certificate"] =
        py::bytes(reinterpret_cast<const char*>(level.certificate->bytes.data()), level.certificate->bytes.size());
  return result;
}

/// `given` are the keyword arguments of meshbound.simplify, lengths in model units.
py::list simplify(const py::array& vertices, const py::array& triangles, const py::dict& given) {
  const MeshView view = view_of(vertices, triangles);
  SimplifyOptions options = library_options(given);
  const py::object progress = taken_progress(given);
  SimplifyResult result;
  run_watched(progress, [&](Watch& watch) {
    options.cancel = &watch.cancel;
    options.progress = watch.progress();
    result = simplify_with_bound(to_triangle_mesh(view), options);
  });
  py::list levels;
  for (SimplifiedLevel& level : result.levels) levels.append(to_dict(level));
  return levels;
}

}  // namespace

void bind_simplification(py::module_& module) { module.def("simplify", &simplify); }

}  // namespace meshbound::python
