// SPDX-License-Identifier: MIT
#include "common/texture_text.h"

#include <cmath>
#include <cstdio>

#include "common/length.h"

namespace meshbound::tools {
namespace {

void print_direction(const char* name, const OneSidedTextureDeviation& direction) {
  std::printf("  %s %s\n", name, interval(direction.bounds).c_str());
  if (direction.witness) {
    const TextureWitness& w = *direction.witness;
    print_line("", "witness " + exact_point(w.from.position) + " to " + exact_point(w.nearest.position) + " at (" +
                       exact_number(w.coordinate.x()) + " " + exact_number(w.coordinate.y()) + ")");
  }
  if (direction.uncovered.upper > 0)
    print_line("", short_number(100 * direction.uncovered.upper) +
                       "% of the area has coordinates that the other mesh does not cover");
}

}  // namespace

void print_texture(const TextureReport& texture, const DirectionNames& names, double diagonal) {
  const Bounds& bounds = texture.deviation.bounds;
  print_line("texture", interval(bounds));
  if (diagonal > 0 && std::isfinite(bounds.upper / diagonal * 100))
    print_line("", short_number(bounds.lower / diagonal * 100) + "% to " + short_number(bounds.upper / diagonal * 100) +
                       "% of the diagonal");
  if (texture.texture_size)
    print_line("", short_number(bounds.lower / texture.texel_length) + " to " +
                       short_number(bounds.upper / texture.texel_length) + " texels of " +
                       exact_number(texture.texel_length));
  if (texture.tolerance) print_line("", "tolerance " + both_units(*texture.tolerance, diagonal));
  if (texture.compares_floats) print_line("", "texture coordinates compared as floats, as one of the files holds them");
  print_direction(names.a_to_b, texture.deviation.a_to_b);
  print_direction(names.b_to_a, texture.deviation.b_to_a);
}

void print_normals(const NormalReport& normals) {
  const NormalDeviation& deviation = normals.deviation;
  print_line("normals", "faces turn by at most " + short_number(deviation.degrees) + " degrees, tolerance " +
                            exact_number(normals.tolerance));
  if (deviation.worst)
    print_line("", "triangle " + std::to_string(deviation.worst->from.triangle) + " at " +
                       short_point(deviation.worst->from.position) + " against triangle " +
                       std::to_string(deviation.worst->nearest.triangle));
}

}  // namespace meshbound::tools
