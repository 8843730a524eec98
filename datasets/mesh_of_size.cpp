// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"

namespace meshbound::datasets {
namespace {

constexpr std::array<std::string_view, 9> known_kinds = {"icosphere",    "uv-sphere", "torus", "cube",   "thin-sheet",
                                                         "spiked-plane", "cylinder",  "gear",  "terrain"};

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

std::span<const std::string_view> kinds() { return known_kinds; }

TriangleMesh mesh_of_size(std::string_view kind, std::size_t faces) {
  if (faces < 1000 || faces > 100'000'000)
    throw InvalidInput("a mesh of a given size needs from 1,000 to 100,000,000 faces");
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
  std::string known;
  for (const std::string_view name : kinds()) known += (known.empty() ? "" : ", ") + std::string(name);
  throw InvalidInput("unknown kind of mesh '" + std::string(kind) + "'; known are " + known);
}

}  // namespace meshbound::datasets
