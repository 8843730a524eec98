// SPDX-License-Identifier: MIT
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "arguments.h"
#include "guard.h"
#include "meshbound/simplify.h"
#include "results.h"
#include "run_control.h"

using namespace meshbound;
using namespace meshbound::c_interface;

struct mb_simplification {
  SimplifyResult result;
};

namespace {

mb_simplify_options default_simplify_options() {
  mb_simplify_options options{};
  options.tolerance = std::numeric_limits<double>::quiet_NaN();
  options.target_faces = MB_NO_TARGET;
  options.target_ratio = -1;
  options.feature_angle = -1;
  options.line_tolerance = -1;
  options.time_limit = std::numeric_limits<double>::infinity();
  return options;
}

/// The value, or absent if it is negative, which is how C callers leave it out. NaN is passed on and refused by the
/// library.
std::optional<double> unless_negative(double value) { return value < 0 ? std::nullopt : std::optional(value); }

/// Converts the enumerators given by the caller; throws for values that this version does not know.
void take_choices(const mb_simplify_options& given, SimplifyOptions& options) {
  if (given.on_exceed != MB_SKIP && given.on_exceed != MB_STOP) throw InvalidInput("on_exceed is no mb_on_exceed");
  if (given.effort != MB_EFFORT_NORMAL && given.effort != MB_EFFORT_HIGH) throw InvalidInput("effort is no mb_effort");
  if (given.placement != MB_OPTIMAL && given.placement != MB_SUBSET) throw InvalidInput("placement is no mb_placement");
  options.on_exceed = given.on_exceed == MB_STOP ? OnExceed::Stop : OnExceed::Skip;
  options.effort = given.effort == MB_EFFORT_HIGH ? Effort::High : Effort::Normal;
  options.placements = given.placement == MB_SUBSET ? CollapsePlacements::Subset : CollapsePlacements::Optimal;
  options.precision = given.single_precision != 0 ? Precision::Single : Precision::Double;
  options.prune = given.prune != 0;
  options.preserve_boundary = given.preserve_boundary != 0;
  options.certificate = given.certificate != 0;
  options.keep_sides = given.keep_sides != 0;
}

SimplifyOptions library_options(const mb_simplify_options& given, const TriangleMesh& mesh, RunControl& control) {
  SimplifyOptions options;
  take_choices(given, options);
  options.tolerance = given.tolerance;
  if (given.level_count > 0) {
    require(given.levels, "levels");
    options.levels.assign(given.levels, given.levels + given.level_count);
  }
  if (given.target_faces != MB_NO_TARGET) options.target_faces = given.target_faces;
  options.target_ratio = unless_negative(given.target_ratio);
  if (given.locked_vertices != nullptr)
    options.locked_vertices.assign(given.locked_vertices, given.locked_vertices + mesh.vertices.size());
  if (given.face_tolerances != nullptr)
    options.face_tolerances.assign(given.face_tolerances, given.face_tolerances + mesh.triangles.size());
  if (given.feature_edge_count > 0) {
    require(given.feature_edges, "feature_edges");
    for (size_t i = 0; i < given.feature_edge_count; ++i)
      options.feature_edges.push_back({given.feature_edges[2 * i], given.feature_edges[2 * i + 1]});
  }
  options.feature_angle = unless_negative(given.feature_angle);
  options.line_tolerance = unless_negative(given.line_tolerance);
  options.time_limit = given.time_limit;
  options.threads = given.threads;
  options.cancel = control.flag();
  options.progress = control.progress();
  return options;
}

mb_level level_of(const SimplifiedLevel& level) {
  static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double) && sizeof(Triangle) == 3 * sizeof(std::uint32_t),
                "vertices and triangles are handed out as packed arrays");
  mb_level result{};
  result.tolerance = level.tolerance;
  result.verdict = to_c(level.verdict);
  result.ended_by = to_c(level.ended_by);
  result.distance = to_c(level.distance.value());
  result.has_lines = level.line_distance ? 1 : 0;
  if (level.line_distance) result.line_distance = to_c(level.line_distance->bounds);
  result.vertex_count = level.mesh.vertices.size();
  result.triangle_count = level.mesh.triangles.size();
  result.positions = reinterpret_cast<const double*>(level.mesh.vertices.data());
  result.indices = reinterpret_cast<const std::uint32_t*>(level.mesh.triangles.data());
  result.source_vertices = level.source_vertex.data();
  result.source_triangles = level.source_triangle.data();
  if (level.certificate) {
    result.certificate = level.certificate->bytes.data();
    result.certificate_size = level.certificate->bytes.size();
  }
  return result;
}

}  // namespace

mb_status mb_simplify_options_init(mb_simplify_options* options, size_t size) {
  return guarded([&] {
    require(options, "options");
    initialise(options, size, default_simplify_options());
  });
}

mb_status mb_simplify(const mb_mesh* original, const mb_simplify_options* options, mb_simplification** result) {
  return guarded(threads_of(options), [&] {
    require(options, "options");
    require(result, "result");
    const mb_simplify_options given = complete(options, mb_simplify_options_init);
    RunControl control(given);
    const TriangleMesh mesh = to_triangle_mesh(valid_view_of(original, "original"));
    auto simplification = std::make_unique<mb_simplification>();
    simplification->result = simplify_with_bound(mesh, library_options(given, mesh, control));
    control.finish();
    *result = simplification.release();
  });
}

void mb_simplification_free(mb_simplification* simplification) { delete simplification; }

size_t mb_simplification_level_count(const mb_simplification* simplification) {
  return simplification == nullptr ? 0 : simplification->result.levels.size();
}

mb_status mb_simplification_level(const mb_simplification* simplification, size_t index, mb_level* level) {
  return guarded([&] {
    require(simplification, "simplification");
    require(level, "level");
    if (index >= simplification->result.levels.size())
      throw InvalidInput("there is no level " + std::to_string(index) + ": there are " +
                         std::to_string(simplification->result.levels.size()));
    *level = level_of(simplification->result.levels[index]);
  });
}

size_t mb_simplification_turned_faces(const mb_simplification* simplification, size_t index) {
  return index < mb_simplification_level_count(simplification) ? simplification->result.levels[index].turned_faces : 0;
}
