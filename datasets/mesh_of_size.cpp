// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"

namespace meshbound::datasets {
namespace {

constexpr std::array<Kind, 9> known_kinds = {
    {{"icosphere", "sphere of radius 1, an icosahedron cut again and again: 320, 1280, 5120, ... faces"},
     {"uv-sphere", "sphere of radius 1, meridians and parallels, long thin faces at the poles"},
     {"torus", "radius 1, tube radius 0.4"},
     {"cube", "side 1, each side a grid"},
     {"thin-sheet", "two grids of side 1, 0.001 apart, closed by a wall"},
     {"spiked-plane", "square of side 1, every 8th inner vertex raised by 0.05; open"},
     {"cylinder", "radius 1, height 2, each cap a fan around one vertex, as in CAD files"},
     {"gear", "spur gear of 24 teeth, radius 1, width 0.25"},
     {"terrain", "fractal heights over a square of side 1; open"}}};

/// The largest n with n * n <= value.
std::size_t integer_root(std::size_t value) {
  auto root = static_cast<std::size_t>(std::sqrt(static_cast<double>(value)));
  while (root * root > value) --root;
  return root;
}

TriangleMesh icosphere_of_size(std::size_t faces) {
  int level = 0;
  for (std::size_t next = 80; next <= faces && level < 12; next *= 4) ++level;
  return icosphere(1, level);
}

TriangleMesh gear_of_size(std::size_t faces) {
  constexpr std::size_t teeth = 24;
  // As many layers as points a tooth gives well-shaped faces: 2 * 24 * n * (n + 1) <= 48 * (n + 1)^2 <= faces.
  const std::size_t n = std::max<std::size_t>(4, integer_root(faces / (2 * teeth)) - 1);
  return gear(1, 0.25, teeth, n, n);
}

}  // namespace

std::span<const Kind> kinds() { return known_kinds; }

std::string kind_names() {
  std::string names;
  for (const Kind& kind : known_kinds) names += (names.empty() ? "" : ", ") + std::string(kind.name);
  return names;
}

TriangleMesh mesh_of_size(std::string_view kind, std::size_t faces) {
  if (faces < 1000 || faces > 100'000'000)
    throw InvalidInput("a mesh of " + std::to_string(faces) +
                       " faces is not made; give a size of 1,000 to 100,000,000");
  const std::size_t half = integer_root(faces / 2);
  const std::size_t quarter = integer_root(faces / 4);
  if (kind == "icosphere") return icosphere_of_size(faces);
  if (kind == "uv-sphere") return uv_sphere(1, quarter, 2 * quarter);
  if (kind == "torus") return torus(1, 0.4, 2 * quarter, quarter);
  if (kind == "cube") return cube(1, static_cast<std::uint32_t>(integer_root(faces / 12)));
  if (kind == "thin-sheet") return thin_sheet(1, 0.001, static_cast<std::uint32_t>(quarter - 1));
  if (kind == "spiked-plane") return spiked_plane(1, 0.05, half, 8);
  if (kind == "cylinder") return cylinder(1, 2, faces / 4);
  if (kind == "gear") return gear_of_size(faces);
  if (kind == "terrain") return terrain(1, half, 2009);
  throw InvalidInput("unknown kind of mesh '" + std::string(kind) + "'; known are " + kind_names());
}

}  // namespace meshbound::datasets
