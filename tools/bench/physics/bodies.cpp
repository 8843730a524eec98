// SPDX-License-Identifier: GPL-3.0-or-later
#include "physics/bodies.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <map>

#include "datasets/analytic_meshes.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "meshbound/mesh_summary.h"
#include "meshbound/simplify.h"
#include "meshes.h"

namespace meshbound::bench {
namespace {

/// Rows from the top; no two squares meet in a corner only, and none of the letters has a hole.
using Glyph = std::array<const char*, 7>;
constexpr std::array<Glyph, 12> glyphs = {{{"#####", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"},    // C
                                           {"#####", "#    ", "#    ", "#####", "#    ", "#    ", "#####"},    // E
                                           {"#####", "#    ", "#    ", "#### ", "#    ", "#    ", "#    "},    // F
                                           {"#####", "#    ", "#    ", "# ###", "#   #", "#   #", "#####"},    // G
                                           {"#   #", "#   #", "#   #", "#####", "#   #", "#   #", "#   #"},    // H
                                           {"#####", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "#####"},    // I
                                           {"#####", "   # ", "   # ", "   # ", "#  # ", "#  # ", "#### "},    // J
                                           {"#    ", "#    ", "#    ", "#    ", "#    ", "#    ", "#####"},    // L
                                           {"#####", "#    ", "#    ", "#####", "    #", "    #", "#####"},    // S
                                           {"#####", "  #  ", "  #  ", "  #  ", "  #  ", "  #  ", "  #  "},    // T
                                           {"#   #", "#   #", "#   #", "#   #", "#   #", "#   #", "#####"},    // U
                                           {"#####", "    #", "  ###", "  #  ", "###  ", "#    ", "#####"}}};  // Z

/// Squares of a grid as a solid of one layer: a face of two triangles on each side where there is no neighbour.
class Extrusion {
 public:
  explicit Extrusion(const Glyph& glyph) : glyph_(glyph) {}

  TriangleMesh make() {
    for (int row = 0; row < 7; ++row)
      for (int column = 0; column < 5; ++column)
        if (is_filled(row, column)) add_square(row, column);
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] bool is_filled(int row, int column) const {
    return row >= 0 && row < 7 && column >= 0 && column < 5 && glyph_[static_cast<std::size_t>(row)][column] == '#';
  }

  /// Corners of the cube of a square: x across the layer, y along the row, z upwards.
  void add_square(int row, int column) {
    const int y = column, z = 6 - row;
    face({1, y, z}, {1, y + 1, z}, {1, y + 1, z + 1}, {1, y, z + 1});
    face({0, y, z}, {0, y, z + 1}, {0, y + 1, z + 1}, {0, y + 1, z});
    if (!is_filled(row, column + 1)) face({0, y + 1, z}, {0, y + 1, z + 1}, {1, y + 1, z + 1}, {1, y + 1, z});
    if (!is_filled(row, column - 1)) face({0, y, z}, {1, y, z}, {1, y, z + 1}, {0, y, z + 1});
    if (!is_filled(row - 1, column)) face({0, y, z + 1}, {1, y, z + 1}, {1, y + 1, z + 1}, {0, y + 1, z + 1});
    if (!is_filled(row + 1, column)) face({0, y, z}, {0, y + 1, z}, {1, y + 1, z}, {1, y, z});
  }

  using Point = std::array<int, 3>;
  std::uint32_t vertex(const Point& p) {
    const auto [it, is_new] = numbers_.emplace(p, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.emplace_back(p[0], p[1], p[2]);
    return it->second;
  }
  void face(const Point& a, const Point& b, const Point& c, const Point& d) {
    mesh_.triangles.push_back({vertex(a), vertex(b), vertex(c)});
    mesh_.triangles.push_back({vertex(a), vertex(c), vertex(d)});
  }

  const Glyph& glyph_;
  TriangleMesh mesh_;
  std::map<Point, std::uint32_t> numbers_;
};

void centre(TriangleMesh& mesh, double longest_side) {
  const Eigen::AlignedBox3d box = used_bounding_box(mesh);
  const double scale = longest_side / box.sizes().maxCoeff();
  for (Eigen::Vector3d& p : mesh.vertices) p = scale * (p - box.center());
}

}  // namespace

std::vector<TriangleMesh> letters(double height) {
  std::vector<TriangleMesh> all;
  for (const Glyph& glyph : glyphs) {
    all.push_back(Extrusion(glyph).make());
    centre(all.back(), height);
  }
  return all;
}

TriangleMesh small_bunny(std::size_t triangles) {
  TriangleMesh bunny;
  if (const auto file = find_dataset({"pairs/bunnyIRMB__bunny.obj", "organic/npm_bunny.ply", "cgal/bunny00.off"})) {
    const TriangleMesh fine = read_mesh(*file).mesh;
    for (std::size_t more = 0; more < 10; ++more) {
      SimplifyOptions options;
      options.tolerance = 0.1 * bounding_box_diagonal(fine);
      options.target_faces = triangles + 10 * more;
      bunny = simplify_with_bound(fine, options).last().mesh;
      centre(bunny, 1);
      try {
        (void)ClosedModel(bunny);
        return bunny;
      } catch (const InvalidInput& problem) {
        std::fprintf(stderr, "physics: a bunny of %zu triangles: %s\n", bunny.triangles.size(), problem.what());
      }
    }
  }
  std::fprintf(stderr, "physics: no closed bunny, taking a gear\n");
  bunny = datasets::mesh_of_size("gear", triangles);
  centre(bunny, 1);
  return bunny;
}

}  // namespace meshbound::bench
