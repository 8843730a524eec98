// SPDX-License-Identifier: MIT
#include <pybind11/stl.h>

#include <optional>
#include <string>
#include <vector>

#include "bind.h"
#include "buffers.h"
#include "meshbound/report.h"
#include "meshbound/simplify.h"
#include "results.h"
#include "watched_run.h"

namespace py = pybind11;

namespace meshbound::python {
namespace {

/// The value of `name` among the keyword arguments, where it is there and not None.
template <class Value>
void take(const py::dict& given, const char* name, Value& value) {
  if (given.contains(name) && !given[name].is_none()) value = given[name].cast<typename std::remove_cvref_t<Value>>();
}

template <class Value>
void take(const py::dict& given, const char* name, std::optional<Value>& value) {
  if (given.contains(name) && !given[name].is_none()) value = given[name].cast<Value>();
}

/// One of two words; throws `InvalidInput` for others.
template <class Choice>
void take_word(const py::dict& given, const char* name, const char* first, const char* second, Choice& choice) {
  if (!given.contains(name) || given[name].is_none()) return;
  const std::string word = given[name].cast<std::string>();
  if (word != first && word != second)
    throw InvalidInput(std::string(name) + " must be \"" + first + "\" or \"" + second + "\"");
  choice = static_cast<Choice>(word == second);
}

SimplifyOptions library_options(const py::dict& given) {
  SimplifyOptions options;
  take(given, "tolerance", options.tolerance);
  take(given, "levels", options.levels);
  take(given, "target_faces", options.target_faces);
  take(given, "target_ratio", options.target_ratio);
  take(given, "prune", options.prune);
  take(given, "preserve_boundary", options.preserve_boundary);
  take(given, "locked_vertices", options.locked_vertices);
  take(given, "feature_angle", options.feature_angle);
  take(given, "line_tolerance", options.line_tolerance);
  take(given, "feature_edges", options.feature_edges);
  take(given, "face_tolerances", options.face_tolerances);
  take(given, "certificate", options.certificate);
  take(given, "time_limit", options.time_limit);
  take(given, "threads", options.threads);
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
  result["certificate"] = py::none();
  if (level.certificate)
    result["certificate"] =
        py::bytes(reinterpret_cast<const char*>(level.certificate->bytes.data()), level.certificate->bytes.size());
  return result;
}

/// `given` are the keyword arguments of meshbound.simplify, lengths in model units.
py::list simplify(const py::array& vertices, const py::array& triangles, const py::dict& given,
                  const py::object& progress) {
  const MeshView view = view_of(vertices, triangles);
  SimplifyOptions options = library_options(given);
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
