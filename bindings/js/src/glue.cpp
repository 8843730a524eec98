// SPDX-License-Identifier: MIT
// The C interface with arguments and results that JavaScript can write and read without knowing the layout of a
// structure: numbers, and arrays of doubles. Functions return 0, or the status of the call that failed.
#include <meshbound.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace {

double address(const void* p) { return static_cast<double>(reinterpret_cast<std::uintptr_t>(p)); }

/// Doubles of a direction: its bounds, both points with their triangles, the outcome.
constexpr std::size_t direction_size = 11;

void write_direction(const mb_direction& direction, double* out) {
  *out++ = direction.bounds.lower;
  *out++ = direction.bounds.upper;
  for (const mb_surface_point* point : {&direction.from, &direction.nearest}) {
    for (const double x : point->position) *out++ = x;
    *out++ = point->triangle;
  }
  *out = direction.outcome;
}

/// 2 + 2 * 11 doubles.
void write_distance(const mb_distance& distance, double* out) {
  out[0] = distance.bounds.lower;
  out[1] = distance.bounds.upper;
  write_direction(distance.a_to_b, out + 2);
  write_direction(distance.b_to_a, out + 2 + direction_size);
}

mb_distance_options options_of(double error_bound, double tolerance, double time_limit, int one_sided) {
  mb_distance_options options;
  mb_distance_options_init(&options, sizeof options);
  options.error_bound = error_bound;
  options.tolerance = tolerance;
  options.time_limit = time_limit;
  options.one_sided = one_sided;
  return options;
}

}  // namespace

extern "C" {

mb_mesh* js_mesh_new(const void* positions, int is_double, std::size_t stride, std::size_t vertex_count,
                     const void* indices, int is_32_bit, std::size_t triangle_count) {
  return new mb_mesh{positions,
                     stride,
                     vertex_count,
                     indices,
                     triangle_count,
                     is_double != 0 ? MB_FLOAT64 : MB_FLOAT32,
                     is_32_bit != 0 ? MB_UINT32 : MB_UINT16};
}

void js_mesh_free(mb_mesh* mesh) { delete mesh; }

/// `out`: vertices, triangles, components, closed, diagonal.
int js_describe(const mb_mesh* mesh, double* out) {
  mb_mesh_facts facts;
  const mb_status status = mb_describe(mesh, &facts);
  if (status != MB_OK) return status;
  const std::array values = {static_cast<double>(facts.vertices), static_cast<double>(facts.triangles),
                             static_cast<double>(facts.components), static_cast<double>(facts.closed),
                             facts.bbox_diagonal};
  for (const double value : values) *out++ = value;
  return MB_OK;
}

/// A negative error bound is the default one, a negative tolerance none.
int js_measure(const mb_mesh* a, const mb_mesh* b, double error_bound, double tolerance, double time_limit,
               int one_sided, double* out) {
  const mb_distance_options options = options_of(error_bound, tolerance, time_limit, one_sided);
  mb_distance distance;
  const mb_status status = mb_measure(a, b, &options, &distance);
  if (status == MB_OK) write_distance(distance, out);
  return status;
}

/// `out`: the verdict, then the distance.
int js_check(const mb_mesh* a, const mb_mesh* b, double tolerance, double time_limit, int one_sided, double* out) {
  const mb_distance_options options = options_of(-1, -1, time_limit, one_sided);
  mb_verdict verdict;
  mb_distance distance;
  const mb_status status = mb_check(a, b, tolerance, &options, &verdict, &distance);
  if (status != MB_OK) return status;
  out[0] = verdict;
  write_distance(distance, out + 1);
  return MB_OK;
}

/// `out`: address and size of the certificate; then `*certificate` is to be freed by `mb_certificate_free`.
int js_certify(const mb_mesh* original, const mb_mesh* simplified, double tolerance, double time_limit,
               mb_certificate** certificate, double* out) {
  const mb_distance_options options = options_of(-1, -1, time_limit, 0);
  const mb_status status = mb_certificate_new(original, simplified, tolerance, &options, certificate);
  if (status != MB_OK) return status;
  out[0] = address(mb_certificate_data(*certificate));
  out[1] = static_cast<double>(mb_certificate_size(*certificate));
  return MB_OK;
}

/// `out`: numbers of vertices and triangles, addresses of positions and indices; then `*file` is to be freed by
/// `mb_mesh_file_free`.
int js_read(const char* path, mb_mesh_file** file, double* out) {
  const mb_status status = mb_mesh_file_read(path, nullptr, file);
  if (status != MB_OK) return status;
  mb_mesh mesh;
  (void)mb_mesh_file_mesh(*file, &mesh);
  const std::array values = {static_cast<double>(mesh.vertex_count), static_cast<double>(mesh.triangle_count),
                             address(mesh.positions), address(mesh.indices)};
  for (const double value : values) *out++ = value;
  return MB_OK;
}

int js_write(const char* path, const mb_mesh* mesh, int single_precision) {
  return mb_mesh_file_write(path, mesh, single_precision, nullptr);
}

mb_simplify_options* js_simplify_options_new() {
  auto* options = new mb_simplify_options;
  mb_simplify_options_init(options, sizeof *options);
  return options;
}

void js_simplify_options_free(mb_simplify_options* options) { delete options; }

void js_set_lengths(mb_simplify_options* options, double tolerance, double line_tolerance, double feature_angle,
                    double time_limit) {
  options->tolerance = tolerance;
  options->line_tolerance = line_tolerance;
  options->feature_angle = feature_angle;
  options->time_limit = time_limit;
}

/// Negative targets are none.
void js_set_targets(mb_simplify_options* options, double faces, double ratio) {
  if (faces >= 0) options->target_faces = static_cast<std::size_t>(faces);
  options->target_ratio = ratio;
}

void js_set_choices(mb_simplify_options* options, int effort_high, int subset, int single_precision, int stop,
                    int prune, int preserve_boundary, int keep_sides, int certificate) {
  options->effort = effort_high != 0 ? MB_EFFORT_HIGH : MB_EFFORT_NORMAL;
  options->placement = subset != 0 ? MB_SUBSET : MB_OPTIMAL;
  options->single_precision = single_precision;
  options->on_exceed = stop != 0 ? MB_STOP : MB_SKIP;
  options->prune = prune;
  options->preserve_boundary = preserve_boundary;
  options->keep_sides = keep_sides;
  options->certificate = certificate;
}

/// Arrays that must stay where they are until `js_simplify` has returned.
void js_set_arrays(mb_simplify_options* options, const double* levels, std::size_t level_count,
                   const std::uint8_t* locked_vertices, const std::uint32_t* feature_edges,
                   std::size_t feature_edge_count) {
  options->levels = levels;
  options->level_count = level_count;
  options->locked_vertices = locked_vertices;
  options->feature_edges = feature_edges;
  options->feature_edge_count = feature_edge_count;
}

int js_simplify(const mb_mesh* original, const mb_simplify_options* options, mb_simplification** result) {
  return mb_simplify(original, options, result);
}

/// `out`: tolerance, verdict, reason of the end, numbers of vertices and triangles, addresses of positions, indices,
/// source vertices, source triangles and certificate, size of the certificate, lower and upper bound of the lines (NaN
/// where there are none), number of turned faces, then the distance.
int js_level(const mb_simplification* simplification, std::size_t index, double* out) {
  mb_level level;
  const mb_status status = mb_simplification_level(simplification, index, &level);
  if (status != MB_OK) return status;
  const double none = __builtin_nan("");
  const std::array values = {level.tolerance,
                             static_cast<double>(level.verdict),
                             static_cast<double>(level.ended_by),
                             static_cast<double>(level.vertex_count),
                             static_cast<double>(level.triangle_count),
                             address(level.positions),
                             address(level.indices),
                             address(level.source_vertices),
                             address(level.source_triangles),
                             address(level.certificate),
                             static_cast<double>(level.certificate_size),
                             level.has_lines != 0 ? level.line_distance.lower : none,
                             level.has_lines != 0 ? level.line_distance.upper : none,
                             static_cast<double>(mb_simplification_turned_faces(simplification, index))};
  for (const double value : values) *out++ = value;
  write_distance(level.distance, out);
  return MB_OK;
}
}
