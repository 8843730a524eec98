// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "fuzz/choices.h"
#include "fuzz/claims.h"
#include "fuzz/enclosure.h"
#include "meshbound/attributes.h"
#include "meshbound/error.h"
#include "meshbound/simplify.h"
#include "verify/verifier.h"

namespace meshbound::fuzz {
namespace {

using reference::exact_distance;

Triangle corner_values(Source& source, std::size_t count) {
  Triangle index;
  for (std::uint32_t& i : index) {
    const unsigned chosen = source.below(static_cast<unsigned>(count) + 1);
    i = chosen == count ? CornerAttribute::none : chosen;
  }
  return index;
}

/// Few values, so that neighbours often agree, and some corners without.
CornerAttribute corner_attribute(Source& source, std::size_t triangles) {
  CornerAttribute attribute;
  for (unsigned i = 1 + source.below(4); i > 0; --i) {
    const double x = source.below(5) / 4.0, y = source.below(5) / 4.0, z = source.below(3) - 1.0;
    attribute.values.emplace_back(x, y, z);
  }
  for (std::size_t i = 0; i < triangles; ++i) attribute.index.push_back(corner_values(source, attribute.values.size()));
  return attribute;
}

MeshAttributes attributes_of(Source& source, std::size_t triangles) {
  MeshAttributes attributes;
  const unsigned which = source.below(16);
  if (which % 2 != 0) attributes.texture_coordinates = corner_attribute(source, triangles);
  if (which / 2 % 2 != 0) attributes.normals = corner_attribute(source, triangles);
  if (which / 4 % 2 != 0) {
    attributes.materials.names = {"wood", "stone"};
    for (std::size_t i = 0; i < triangles; ++i)
      attributes.materials.index.push_back(std::array{0U, 1U, CornerAttribute::none}[source.below(3)]);
  }
  if (which / 8 % 2 != 0) {
    NamedAttribute colours;
    colours.name = "COLOR_0";
    colours.width = 3 + source.below(2);
    colours.interpolation = static_cast<Interpolation>(source.below(3));
    colours.values.assign(3 * colours.width, 0.25 * source.below(5));
    colours.values[0] = 1;
    for (std::size_t i = 0; i < triangles; ++i) colours.index.push_back(corner_values(source, 3));
    attributes.named.push_back(colours);
  }
  return attributes;
}

double size_of(const TriangleMesh& mesh) {
  double size = 0;
  for (const Eigen::Vector3d& p : mesh.vertices) size = std::max(size, p.cwiseAbs().maxCoeff());
  return size;
}

void add_texture(SimplifyOptions& options, const MeshAttributes& attributes) {
  for (const Triangle& index : attributes.texture_coordinates.index) {
    std::array<Eigen::Vector2d, 3>& corners = options.texture_coordinates.emplace_back();
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = index[k] == CornerAttribute::none
                       ? Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN())
                       : Eigen::Vector2d(attributes.texture_coordinates.values[index[k]].head<2>());
  }
  options.materials = attributes.materials.index;
}

SimplifyOptions options_for(Source& source, const TriangleMesh& mesh, const MeshAttributes& attributes) {
  const double size = size_of(mesh);
  const auto length = [&] { return std::ldexp(size, 1 - static_cast<int>(source.below(32))); };
  SimplifyOptions options;
  options.threads = 1;
  options.tolerance = length();
  const unsigned bits = source.take<std::uint8_t>(), more = source.take<std::uint8_t>();
  options.on_exceed = bits % 8 == 7 ? OnExceed::Stop : OnExceed::Skip;
  options.effort = bits / 8 % 4 == 3 ? Effort::High : Effort::Normal;
  options.prune = bits / 32 % 2 != 0;
  options.preserve_boundary = bits / 64 == 3;
  options.placements = more % 4 == 3 ? CollapsePlacements::Subset : CollapsePlacements::Optimal;
  options.precision = more / 4 % 4 == 3 ? Precision::Single : Precision::Double;
  options.certificate = more / 16 % 4 == 3;
  if (more / 64 % 2 != 0) options.levels = {options.tolerance / 2};
  if (more / 128 != 0) options.feature_angle = std::numbers::pi * source.below(5) / 4;
  const unsigned rest = source.take<std::uint8_t>();
  if (rest % 4 == 3) options.line_tolerance = length();
  if (!attributes.empty()) options.feature_edges = seams(mesh, attributes);
  if (rest / 4 % 4 == 3)
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) options.face_tolerances.push_back(length());
  if (rest / 16 % 4 == 3)
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) options.locked_vertices.push_back(source.below(4) == 0);
  if (rest / 64 == 3) options.target_faces = source.below(8);
  if (rest / 64 == 1) {
    add_texture(options, attributes);
    const double tolerance = length();
    if (!options.texture_coordinates.empty()) options.texture_tolerance = tolerance;
  }
  const unsigned normals = source.take<std::uint8_t>();
  if (normals % 4 == 3) options.normal_tolerance = 180.0 * (normals / 4) / 63;
  return options;
}

void check_distance_of(const HausdorffDistance& found, const TriangleMesh& a, const TriangleMesh& b) {
  const Enclosure forward = enclosure(a, b), backward = enclosure(b, a);
  check_bounds(found.a_to_b.bounds, forward);
  check_bounds(found.b_to_a.bounds, backward);
}

/// Checks what a level must keep whose verdict is `Within`.
void check_within(const SimplifiedLevel& level, const TriangleMesh& original, const std::vector<Edge>& lines,
                  const SimplifyOptions& options) {
  if (level.verdict != Verdict::Within) return;
  require(level.distance && level.distance->bounds.upper <= level.tolerance, "within, but upper is not");
  if (level.line_distance) {
    require(level.line_distance->bounds.upper <= std::min(level.tolerance, options.line_tolerance.value_or(HUGE_VAL)),
            "within, but the lines are not");
    check_distance_of(*level.line_distance, line_mesh(original, lines), line_mesh(level.mesh, level.lines));
  }
  for (std::size_t i = 0; i < options.face_tolerances.size(); ++i)
    for (const std::uint32_t v : original.triangles[i])
      require(exact_distance(original.vertices[v], level.mesh)
                      .compare(std::min(level.tolerance, options.face_tolerances[i])) <= 0,
              "a corner is further away than its triangle may be");
}

void check_sources(const SimplifiedLevel& level, const TriangleMesh& original, const SimplifyOptions& options) {
  require(level.source_vertex.size() == level.mesh.vertices.size(), "a source for each vertex");
  require(level.source_triangle.size() == level.mesh.triangles.size(), "a source for each triangle");
  for (std::size_t i = 0; i < level.source_vertex.size(); ++i) {
    require(level.source_vertex[i] < original.vertices.size(), "the source of a vertex is one of the original");
    const Eigen::Vector3d& source = original.vertices[level.source_vertex[i]];  // no number where no triangle uses it
    if (options.placements == CollapsePlacements::Subset && options.precision == Precision::Double)
      require(level.mesh.vertices[i] == source || source.hasNaN(), "a subset stands where it stood");
  }
  require(options.texture_coordinates.empty() || level.texture_coordinates.size() == level.mesh.triangles.size(),
          "texture coordinates for each triangle");
  for (const std::uint32_t t : level.source_triangle)
    require(t < original.triangles.size(), "the source of a triangle is one of the original");
  if (options.precision == Precision::Double) return;
  for (const Triangle& t : level.mesh.triangles)
    for (const std::uint32_t v : t)
      require(level.mesh.vertices[v].cast<float>().cast<double>() == level.mesh.vertices[v],
              "a coordinate is not a float");
}

/// Two vertices may be one for the decimation where they are nearer to each other than its coordinates can tell. What
/// only triangles use that lie on others goes with these.
void check_locked(const SimplifiedLevel& level, const TriangleMesh& original, const SimplifyOptions& options) {
  if (options.locked_vertices.empty() || options.precision == Precision::Single) return;
  const double rounding = std::ldexp(size_of(original), -48);
  for (const Triangle& t : original.triangles) {
    for (const std::uint32_t v : t) {
      const auto stands_there = [&](const Eigen::Vector3d& p) {
        return ((p - original.vertices[v]).array().abs() <= rounding).all();
      };
      require(!options.locked_vertices[v] ||
                  std::any_of(level.mesh.vertices.begin(), level.mesh.vertices.end(), stands_there),
              "a locked vertex is gone");
    }
  }
}

void check_certificate_of(const SimplifiedLevel& level, const TriangleMesh& original) {
  if (!level.certificate) return;
  require(level.verdict == Verdict::Within, "a certificate of what is not within its tolerance");
  const double proven = verify::check_certificate(original, level.mesh, level.certificate->bytes).tolerance;
  require(proven <= level.tolerance, "the certificate proves less than the tolerance");
}

void check_attributes_of(const SimplifiedLevel& level, const TriangleMesh& original, const MeshAttributes& attributes) {
  if (attributes.empty()) return;
  const MeshAttributes carried = transferred_attributes(original, attributes, level);
  (void)seams(level.mesh, carried);  // throws where they do not fit
  require(carried.texture_coordinates.empty() == attributes.texture_coordinates.empty() &&
              carried.normals.empty() == attributes.normals.empty() &&
              carried.named.size() == attributes.named.size() &&
              carried.materials.empty() == attributes.materials.empty(),
          "an attribute is gone");
  for (const Eigen::Vector3d& value : carried.texture_coordinates.values)
    require(value.allFinite(), "a texture coordinate that is not finite");
  for (const Eigen::Vector3d& value : carried.normals.values) require(value.allFinite(), "a normal that is not finite");
}

}  // namespace

void check_simplify(Bytes content) {
  Source source(content);
  const unsigned kind = source.take<std::uint8_t>();
  const TriangleMesh original = source.mesh(kind);
  const MeshAttributes attributes = attributes_of(source, original.triangles.size());
  std::optional<SimplifyOptions> options;
  std::optional<SimplifyResult> result;
  try {
    options = options_for(source, original, attributes);
    result = simplify_with_bound(original, *options);
  } catch (const InvalidInput&) {
    return;  // a coordinate that is not finite or too large
  }
  for (const SimplifiedLevel& level : result->levels) {
    validate(level.mesh);
    require(level.distance.has_value(), "a level that is not measured");
    check_distance_of(*level.distance, original, level.mesh);
    check_within(level, original, result->lines, *options);
    check_sources(level, original, *options);
    if (result->dropped_triangles == 0) check_locked(level, original, *options);
    check_certificate_of(level, original);
    check_attributes_of(level, original, attributes);
  }
}

}  // namespace meshbound::fuzz
