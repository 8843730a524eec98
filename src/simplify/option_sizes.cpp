// SPDX-License-Identifier: MIT
#include "simplify/option_sizes.h"

#include <algorithm>
#include <string>

#include "meshbound/error.h"

namespace meshbound {
namespace {

void check_size(std::size_t size, std::size_t expected, const char* what, const char* of) {
  if (size != 0 && size != expected)
    throw InvalidInput(std::string(what) + " must be given for every " + of + " of the original, or not at all");
}

}  // namespace

void check_sizes(const SimplifyOptions& options, std::size_t vertices, std::size_t triangles) {
  check_size(options.locked_vertices.size(), vertices, "the locked vertices", "vertex");
  check_size(options.face_tolerances.size(), triangles, "tolerances of triangles", "triangle");
  check_size(options.texture_coordinates.size(), triangles, "texture coordinates", "triangle");
  check_size(options.materials.size(), triangles, "materials", "triangle");
  check_size(options.looks.size(), triangles, "looks", "triangle");
  for (const auto& [a, b] : options.feature_edges)
    if (std::max(a, b) >= vertices)
      throw InvalidInput("a feature edge refers to vertex " + std::to_string(std::max(a, b)) + ", but there are only " +
                         std::to_string(vertices));
  for (const double tolerance : options.face_tolerances)
    if (!(tolerance >= 0)) throw InvalidInput("the tolerance of a triangle must be a length, 0 or more");
}

}  // namespace meshbound
