// SPDX-License-Identifier: MIT
/// The connected volumes of the intersection: shells, which are closed surfaces made of pieces, each with its cavities.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "meshbound/penetration_depth.h"
#include "penetration/curves.h"
#include "penetration/face_borders.h"
#include "penetration/pieces.h"
#include "penetration/placed_pair.h"

namespace meshbound {

/// A triangle of a patch.
struct PatchTriangle {
  std::uint32_t first_source = 0, end_source = 0;  ///< in `Patch::sources`: it lies on these triangles of the model
  CornerTriple corners;
};

/// The part of the boundary of a volume that lies on one model.
struct Patch {
  std::vector<PatchTriangle> triangles;  ///< none without area
  std::vector<std::uint32_t> sources;    ///< triangles of the model
  std::size_t faces = 0;                 ///< triangles of the model that it lies on
  double displacement = 0;  ///< distance between the part and its rounded image, either way, at most; local

  void add(std::uint32_t source, const CornerTriple& corners);
  void add(const Patch& other);
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
  /// What is cut into triangles: faces, whose pieces are joined, or each piece by itself.
  enum class Cut { Faces, Pieces };
  /// Adds to `flush_corners` of the curves.
  std::vector<IntersectionVolume> find(PlacedPair& pair, CrossingCurves& curves, Pieces& pieces, Cut cut);

 private:
  struct Shell {
    std::vector<std::uint32_t> pieces;
    std::array<Patch, 2> patches;  ///< by side; empty unless it has content
    Bounds content;
    int sign = 0;
    std::size_t volume = 0;
  };

  void find_sign(Shell& shell);
  template <class Visit>
  void visit_fans(const Shell& shell, const Visit& visit);
  void measure_content(Shell& shell);
  [[nodiscard]] int exact_content_sign(const Shell& shell);
  void triangulate_shell(Shell& shell, Cut cut);
  void triangulate_face(std::span<const std::uint32_t> face, Cut cut, Shell& shell);
  [[nodiscard]] std::size_t shell_around(const Shell& cavity, const std::vector<Shell>& shells);
  [[nodiscard]] int parity_of(const Shell& shell, const Vec3& from, const Vec3& direction) const;
  void surround(IntersectionVolume& volume, const Shell& outer);
  [[nodiscard]] std::uint32_t component_around(std::uint32_t side, const Shell& shell);
  void add_component(IntersectionVolume& volume, std::uint32_t side, std::uint32_t component);

  [[nodiscard]] const Vec3& position(std::uint32_t side, PieceCorner corner) const;
  [[nodiscard]] double error(std::uint32_t side, PieceCorner corner) const;

  PlacedPair* pair_ = nullptr;
  const CrossingCurves* curves_ = nullptr;
  Pieces* pieces_ = nullptr;
  FaceBorders borders_;
  std::vector<CornerTriple> triangles_;
};

}  // namespace meshbound
