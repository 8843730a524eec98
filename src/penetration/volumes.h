// SPDX-License-Identifier: MIT
/// The connected volumes of the intersection: shells, which are closed surfaces made of pieces, each with its cavities.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "meshbound/penetration_depth.h"
#include "penetration/curves.h"
#include "penetration/pieces.h"
#include "penetration/placed_pair.h"
#include "penetration/triangulate.h"

namespace meshbound {

/// A piece of the surface of a model as triangles.
struct PatchTriangle {
  std::uint32_t source = 0;  ///< the triangle of the model that it lies on
  CornerTriple corners;
  bool is_flat = false;  ///< has no area
};

/// The part of the boundary of a volume that lies on one model.
struct Patch {
  std::vector<PatchTriangle> triangles;
  std::size_t faces = 0;    ///< triangles of the model that it lies on
  double displacement = 0;  ///< distance between the part and its rounded image, either way, at most; local
};

/// A volume of the intersection, in local units.
struct IntersectionVolume {
  std::array<Patch, 2> patches;  ///< by side
  Overlap overlap = Overlap::Crossing;
  Bounds content;  ///< local unit cubed
};

/// Finds the volumes that have content, in the order of their first pieces.
class VolumeFinder {
 public:
  /// Adds to `flush_corners` of the curves.
  std::vector<IntersectionVolume> find(PlacedPair& pair, CrossingCurves& curves, Pieces& pieces);

 private:
  struct Shell {
    std::vector<std::uint32_t> pieces;
    std::array<std::vector<PatchTriangle>, 2> triangles;
    std::array<double, 2> excess{0, 0};
    Bounds content;
    int sign = 0;
    std::size_t volume = 0;
  };

  void gather(Shell& shell);
  void add_triangles(std::uint32_t piece, Shell& shell);
  void measure_content(Shell& shell);
  [[nodiscard]] int exact_content_sign(const Shell& shell);
  [[nodiscard]] std::size_t shell_around(const Shell& cavity, const std::vector<Shell>& shells);
  [[nodiscard]] int parity_of(const Shell& shell, const Vec3& from, const Vec3& direction) const;
  void surround(IntersectionVolume& volume, const Shell& outer);
  [[nodiscard]] std::uint32_t component_around(std::uint32_t side, const Shell& shell);
  void add_component(IntersectionVolume& volume, std::uint32_t side, std::uint32_t component);

  [[nodiscard]] const Vec3& position(std::uint32_t side, PieceCorner corner) const;
  [[nodiscard]] double error(std::uint32_t side, PieceCorner corner) const;

  PlacedPair* pair_ = nullptr;
  const CrossingCurves* curves_ = nullptr;
  const Pieces* pieces_ = nullptr;
  std::vector<CornerTriple> triangles_;
};

}  // namespace meshbound
