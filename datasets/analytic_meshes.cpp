// SPDX-License-Identifier: MIT
#include "datasets/analytic_meshes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <unordered_map>

#include "meshbound/error.h"

namespace meshbound::datasets {
namespace {

using Eigen::Vector3d;

constexpr double full_turn = 2 * std::numbers::pi;

void require(bool condition, const char* message) {
  if (!condition) throw InvalidInput(std::string("analytic mesh: ") + message);
}

bool is_length(double value) { return std::isfinite(value) && value > 0; }

std::uint32_t add_vertex(TriangleMesh& mesh, const Vector3d& position) {
  mesh.vertices.push_back(position);
  return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
}

/// Two triangles for the quadrangle a b c d, given counter-clockwise.
void add_quad(TriangleMesh& mesh, std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

/// Vertex numbers of a grid of `rows` x `columns` vertices that starts at vertex `first`; indices wrap around.
struct Grid {
  std::uint32_t first;
  std::size_t rows;
  std::size_t columns;

  [[nodiscard]] std::uint32_t at(std::size_t row, std::size_t column) const {
    return first + static_cast<std::uint32_t>((row % rows) * columns + column % columns);
  }
};

/// Faces between neighbours of a grid. `strips` and `cells` count the quadrangles of both directions: one less than
/// the vertices where the grid is open, as many where it closes on itself.
void add_grid_faces(TriangleMesh& mesh, const Grid& grid, std::size_t strips, std::size_t cells) {
  for (std::size_t i = 0; i < strips; ++i)
    for (std::size_t j = 0; j < cells; ++j)
      add_quad(mesh, grid.at(i, j), grid.at(i, j + 1), grid.at(i + 1, j + 1), grid.at(i + 1, j));
}

/// (cells+1)^2 vertices (x, y, height(i, j)) over [0,side]^2 with their faces, which look up.
template <class Height>
TriangleMesh height_field(double side, std::size_t cells, const Height& height) {
  require(is_length(side) && cells >= 1, "the side must be a positive length and there must be at least one cell");
  TriangleMesh mesh;
  mesh.vertices.reserve((cells + 1) * (cells + 1));
  mesh.triangles.reserve(2 * cells * cells);
  const double step = side / static_cast<double>(cells);
  for (std::size_t j = 0; j <= cells; ++j)
    for (std::size_t i = 0; i <= cells; ++i)
      add_vertex(mesh, {step * static_cast<double>(i), step * static_cast<double>(j), height(i, j)});
  add_grid_faces(mesh, {0, cells + 1, cells + 1}, cells, cells);
  return mesh;
}

/// Regular icosahedron: the corners of three golden rectangles.
TriangleMesh icosahedron() {
  constexpr double g = std::numbers::phi;
  return {{{-1, g, 0},
           {1, g, 0},
           {-1, -g, 0},
           {1, -g, 0},
           {0, -1, g},
           {0, 1, g},
           {0, -1, -g},
           {0, 1, -g},
           {g, 0, -1},
           {g, 0, 1},
           {-g, 0, -1},
           {-g, 0, 1}},
          {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
           {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
           {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
}

/// Each triangle into four, through the midpoints of its edges; neighbours share them.
TriangleMesh quartered(const TriangleMesh& coarse) {
  TriangleMesh fine;
  fine.vertices = coarse.vertices;
  fine.triangles.reserve(4 * coarse.triangles.size());
  std::unordered_map<std::uint64_t, std::uint32_t> midpoints;
  const auto midpoint = [&](std::uint32_t a, std::uint32_t b) {
    const auto [entry, is_new] = midpoints.try_emplace((std::uint64_t{std::min(a, b)} << 32U) | std::max(a, b));
    if (is_new) entry->second = add_vertex(fine, (fine.vertices[a] + fine.vertices[b]) / 2);
    return entry->second;
  };
  for (const auto& [a, b, c] : coarse.triangles) {
    const std::uint32_t ab = midpoint(a, b);
    const std::uint32_t bc = midpoint(b, c);
    const std::uint32_t ca = midpoint(c, a);
    for (const Triangle& t : {Triangle{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}}) fine.triangles.push_back(t);
  }
  return fine;
}

/// splitmix64 (Steele, Lea, Flood 2014): every input bit reaches every output bit.
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15U;
  value = (value ^ (value >> 30U)) * 0xbf58476d1ce4e5b9U;
  value = (value ^ (value >> 27U)) * 0x94d049bb133111ebU;
  return value ^ (value >> 31U);
}

/// A number of [0,1) that belongs to a lattice point.
double lattice_value(std::uint64_t x, std::uint64_t y, std::uint64_t seed) {
  return static_cast<double>(mixed(mixed(mixed(seed) ^ x) ^ y) >> 11U) * 0x1p-53;
}

/// Smooth interpolation of the lattice values around (x, y), x and y >= 0.
double value_noise(double x, double y, std::uint64_t seed) {
  const double x_floor = std::floor(x);
  const double y_floor = std::floor(y);
  const auto smooth = [](double t) { return t * t * (3 - 2 * t); };
  const double u = smooth(x - x_floor);
  const double v = smooth(y - y_floor);
  const auto i = static_cast<std::uint64_t>(x_floor);
  const auto j = static_cast<std::uint64_t>(y_floor);
  const double near = lattice_value(i, j, seed) * (1 - u) + lattice_value(i + 1, j, seed) * u;
  const double far = lattice_value(i, j + 1, seed) * (1 - u) + lattice_value(i + 1, j + 1, seed) * u;
  return near * (1 - v) + far * v;
}

}  // namespace

TriangleMesh icosphere(double radius, int level) {
  require(is_length(radius) && level >= 0 && level <= 12, "icosphere needs a positive radius and a level from 0 to 12");
  TriangleMesh mesh = icosahedron();
  for (int i = 0; i < level; ++i) mesh = quartered(mesh);
  for (Vector3d& vertex : mesh.vertices) vertex *= radius / vertex.norm();
  return mesh;
}

TriangleMesh uv_sphere(double radius, std::size_t rings, std::size_t segments) {
  require(is_length(radius) && rings >= 2 && segments >= 3, "uv_sphere needs 2 rings and 3 segments or more");
  TriangleMesh mesh;
  for (std::size_t i = 1; i < rings; ++i) {
    const double polar = std::numbers::pi * (1 - static_cast<double>(i) / static_cast<double>(rings));
    for (std::size_t j = 0; j < segments; ++j) {
      const double azimuth = full_turn * static_cast<double>(j) / static_cast<double>(segments);
      add_vertex(mesh, radius * Vector3d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                         std::cos(polar)));
    }
  }
  const Grid grid{0, rings - 1, segments};
  add_grid_faces(mesh, grid, rings - 2, segments);
  const std::uint32_t south = add_vertex(mesh, {0, 0, -radius});
  const std::uint32_t north = add_vertex(mesh, {0, 0, radius});
  for (std::size_t j = 0; j < segments; ++j) {
    mesh.triangles.push_back({south, grid.at(0, j + 1), grid.at(0, j)});
    mesh.triangles.push_back({north, grid.at(rings - 2, j), grid.at(rings - 2, j + 1)});
  }
  return mesh;
}

TriangleMesh torus(double radius, double tube_radius, std::size_t around, std::size_t across) {
  require(is_length(tube_radius) && std::isfinite(radius) && tube_radius < radius, "torus: 0 < tube_radius < radius");
  require(around >= 3 && across >= 3, "torus needs 3 segments or more in both directions");
  TriangleMesh mesh;
  for (std::size_t i = 0; i < around; ++i) {
    const double azimuth = full_turn * static_cast<double>(i) / static_cast<double>(around);
    for (std::size_t j = 0; j < across; ++j) {
      const double turn = -full_turn * static_cast<double>(j) / static_cast<double>(across);
      const double distance = radius + tube_radius * std::cos(turn);
      add_vertex(mesh, {distance * std::cos(azimuth), distance * std::sin(azimuth), tube_radius * std::sin(turn)});
    }
  }
  add_grid_faces(mesh, {0, around, across}, around, across);
  return mesh;
}

TriangleMesh box(const Vector3d& size, const std::array<std::uint32_t, 3>& cells) {
  require(is_length(size.x()) && is_length(size.y()) && is_length(size.z()), "box needs three positive lengths");
  for (const std::uint32_t count : cells)
    require(count >= 1 && count < (1U << 20U), "box needs from 1 to 2^20 - 1 cells in each direction");
  TriangleMesh mesh;
  std::unordered_map<std::uint64_t, std::uint32_t> known;  // lattice point, 21 bits a coordinate -> vertex
  const auto vertex = [&](const std::array<std::uint32_t, 3>& p) {
    const std::uint64_t key = (std::uint64_t{p[0]} << 42U) | (std::uint64_t{p[1]} << 21U) | p[2];
    const auto [entry, is_new] = known.try_emplace(key);
    if (is_new)
      entry->second =
          add_vertex(mesh, {size.x() * p[0] / cells[0], size.y() * p[1] / cells[1], size.z() * p[2] / cells[2]});
    return entry->second;
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const auto corner = [&](std::uint32_t on_axis, std::uint32_t on_u, std::uint32_t on_v) {
      std::array<std::uint32_t, 3> point{};
      point[axis] = on_axis;
      point[u] = on_u;
      point[v] = on_v;
      return vertex(point);
    };
    for (std::uint32_t i = 0; i < cells[u]; ++i) {
      for (std::uint32_t j = 0; j < cells[v]; ++j) {
        const std::uint32_t top = cells[axis];
        add_quad(mesh, corner(top, i, j), corner(top, i + 1, j), corner(top, i + 1, j + 1), corner(top, i, j + 1));
        add_quad(mesh, corner(0, i, j), corner(0, i, j + 1), corner(0, i + 1, j + 1), corner(0, i + 1, j));
      }
    }
  }
  return mesh;
}

TriangleMesh cube(double side, std::uint32_t cells) { return box({side, side, side}, {cells, cells, cells}); }

TriangleMesh thin_sheet(double side, double thickness, std::uint32_t cells) {
  return box({side, side, thickness}, {cells, cells, 1});
}

TriangleMesh spiked_plane(double side, double height, std::size_t cells, std::size_t spacing) {
  require(is_length(height) && spacing >= 1, "spiked_plane needs a positive height and spacing");
  return height_field(side, cells, [=](std::size_t i, std::size_t j) {
    const bool inner = i > 0 && j > 0 && i < cells && j < cells;
    return inner && i % spacing == 0 && j % spacing == 0 ? height : 0.0;
  });
}

TriangleMesh cylinder(double radius, double height, std::size_t segments) {
  require(is_length(radius) && is_length(height), "cylinder needs a positive radius and height");
  require(segments >= 3, "cylinder needs 3 segments or more");
  TriangleMesh mesh;
  for (const double z : {0.0, height}) {
    for (std::size_t j = 0; j < segments; ++j) {
      const double angle = full_turn * static_cast<double>(j) / static_cast<double>(segments);
      add_vertex(mesh, {radius * std::cos(angle), radius * std::sin(angle), z});
    }
  }
  const Grid grid{0, 2, segments};
  add_grid_faces(mesh, grid, 1, segments);
  const std::uint32_t bottom = add_vertex(mesh, {0, 0, 0});
  const std::uint32_t top = add_vertex(mesh, {0, 0, height});
  for (std::size_t j = 0; j < segments; ++j) {
    mesh.triangles.push_back({bottom, grid.at(0, j + 1), grid.at(0, j)});
    mesh.triangles.push_back({top, grid.at(1, j), grid.at(1, j + 1)});
  }
  return mesh;
}

TriangleMesh gear(double radius, double width, std::size_t teeth, std::size_t points_per_tooth, std::size_t layers) {
  require(is_length(radius) && is_length(width), "gear needs a positive radius and width");
  require(teeth >= 3 && points_per_tooth >= 4 && layers >= 1,
          "gear needs 3 teeth, 4 points a tooth and 1 layer or more");
  const std::size_t around = teeth * points_per_tooth;
  TriangleMesh mesh;
  for (std::size_t i = 0; i <= layers; ++i) {
    const double z = width * static_cast<double>(i) / static_cast<double>(layers);
    for (std::size_t j = 0; j < around; ++j) {
      const double angle = full_turn * static_cast<double>(j) / static_cast<double>(around);
      // A sine of four times the tooth's height, cut off at the top and bottom land: steep flanks between flat lands.
      const double phase =
          full_turn * static_cast<double>(j % points_per_tooth) / static_cast<double>(points_per_tooth);
      const double profile = std::clamp(0.5 + 2 * std::sin(phase), 0.0, 1.0);
      const double distance = radius * (0.875 + 0.125 * profile);
      add_vertex(mesh, {distance * std::cos(angle), distance * std::sin(angle), z});
    }
  }
  const Grid grid{0, layers + 1, around};
  add_grid_faces(mesh, grid, layers, around);
  const std::uint32_t bottom = add_vertex(mesh, {0, 0, 0});
  const std::uint32_t top = add_vertex(mesh, {0, 0, width});
  for (std::size_t j = 0; j < around; ++j) {
    mesh.triangles.push_back({bottom, grid.at(0, j + 1), grid.at(0, j)});
    mesh.triangles.push_back({top, grid.at(layers, j), grid.at(layers, j + 1)});
  }
  return mesh;
}

TriangleMesh terrain(double side, std::size_t cells, std::uint64_t seed) {
  constexpr int octaves = 10;  // the last has 1,536 waves a side: detail down to the cells of 4M triangles
  return height_field(side, cells, [=](std::size_t i, std::size_t j) {
    double sum = 0;
    double amplitude = 0.125;
    double frequency = 3 / static_cast<double>(cells);
    for (int octave = 0; octave < octaves; ++octave) {
      sum += amplitude * value_noise(frequency * static_cast<double>(i), frequency * static_cast<double>(j),
                                     seed + static_cast<std::uint64_t>(octave));
      amplitude /= 2;
      frequency *= 2;
    }
    return side * sum;
  });
}

}  // namespace meshbound::datasets
