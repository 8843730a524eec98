// SPDX-License-Identifier: MIT
/// Refuses collapses after which faces of the original would turn too much, by the samples around them.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "numeric/marked_ids.h"
#include "simplify/kernel/kernels.h"
#include "simplify/normals/face_turns.h"

namespace meshbound {

/// The faces around the edge of a collapse.
struct TurnedStar {
  std::span<const Corner> moved;           ///< of faces that stay: the corner that moves
  std::span<const std::uint32_t> removed;  ///< faces that go
  Vec3 origin;                             ///< a point nearby
};

/// Compares the samples around a collapse with the faces as they would be: each must turn little from the nearest face,
/// or from one of those that are nearest. Each thread needs its own.
class TurnGuard {
 public:
  TurnGuard(const FaceTurns& turns, const ArrayMesh& mesh);

  /// Selects the region of the next stars, and what is known of regions: see `Split`.
  void enter(std::span<const std::uint32_t> region_of_face, std::uint32_t region) {
    region_of_face_ = region_of_face;
    region_ = region;
  }
  /// Starts anew with these faces. O(samples).
  void begin(const TurnedStar& star);
  /// Whether no sample of the star turns too much with the vertex at `point`. `faces` are those that stay, relative to
  /// the origin of the star. Other faces count where they are nearer: those that hold rivals of a sample, unless other
  /// regions may change them. O(samples * faces); what refused the last placement is looked at first.
  [[nodiscard]] bool holds_inside(Vec3 point, std::span<const SampleFace> faces);
  /// After that, what takes longer: faces beside those that hold near rivals count as well, and samples outside the
  /// star must not turn too much. One of the faces may come nearer to those of faces beside it, and to those that have
  /// a rival in the star, than their own; those of other regions are left out. O(samples * faces).
  [[nodiscard]] bool holds_around(std::span<const SampleFace> faces);
  /// After a refusal: how much the sample turned that decided it, in tolerances.
  [[nodiscard]] float deviation() const { return deviation_; }
  /// Assigns the samples to the faces that stay, as `holds_inside` has placed them last.
  void give_samples(FaceTurns& turns);

 private:
  struct Face {
    TriangleCorners corners;  ///< the moving one first
    Vec3 normal;
    std::uint32_t number = 0;
  };
  /// Samples compared with the faces that stay.
  struct Compared {
    std::vector<std::uint32_t> samples;
    SamplePoints points;
    std::vector<SampleDistances> distances;

    void clear();
    void put_first(std::size_t i);
    [[nodiscard]] std::size_t nearest(std::size_t i) const;
    void set_nearest(std::size_t i, std::size_t face);
    [[nodiscard]] double squared(std::size_t i) const;
  };
  /// What a sample is nearest to among the faces of the star that stay.
  struct Nearest {
    const Face* face = nullptr;
    double squared = HUGE_VAL;      ///< distance between the sample and that face
    const Face* allowed = nullptr;  ///< the nearest of those faces that the sample turns little from
    double squared_of_allowed = HUGE_VAL;
  };
  /// A face outside the star that a sample turns too much from.
  struct RivalFace {
    double squared = 0;  ///< distance between the sample and that face
    Vec3 normal;         ///< of that face
  };
  void add(std::uint32_t sample, Compared& to) const;
  /// Compares the samples block by block, and asks holds(i) for each: the first one that does not hold.
  template <class Holds>
  std::optional<std::size_t> first_refused(Compared& compared, std::span<const SampleFace> faces, const Holds& holds);
  /// Whether no other thread changes the face: it is of the same region, or between regions and stays as it is.
  [[nodiscard]] bool is_readable(std::uint32_t face) const {
    return region_of_face_.empty() || region_of_face_[face] == region_ || region_of_face_[face] == no_index;
  }
  void look_at(std::uint32_t face, const FaceTurns::Sample& sample, double below,
               std::optional<RivalFace>& nearest) const;
  [[nodiscard]] std::optional<RivalFace> nearest_rival(std::size_t i) const;
  [[nodiscard]] std::optional<RivalFace> nearest_beside_rivals(std::size_t i) const;
  [[nodiscard]] Nearest nearest_face(const FaceTurns::Sample& sample) const;
  [[nodiscard]] bool holds_own(std::size_t i);
  [[nodiscard]] bool holds_against(std::size_t i, const std::optional<RivalFace>& rival);
  [[nodiscard]] bool holds_other(std::size_t i);
  void find_others();

  const FaceTurns& turns_;
  const ArrayMesh& mesh_;
  SampleKernel kernel_ = simplify_kernels().samples;
  std::span<const std::uint32_t> region_of_face_;
  std::uint32_t region_ = 0;
  Vec3 origin_;
  std::vector<Corner> moved_;
  std::vector<Face> faces_;               ///< that stay
  std::vector<std::uint32_t> star_;       ///< all faces
  MarkedIds in_star_, around_;            ///< faces: these, and those beside them that are read
  Compared own_;                          ///< samples of the star
  Compared others_;                       ///< samples of faces around it, or with rivals in it
  std::vector<double> squared_from_own_;  ///< by sample of `others_`: from its face; negative: not known yet
  bool has_others_ = false;               ///< they are known
  std::vector<std::uint32_t> numbers_;
  float deviation_ = 0;
};

}  // namespace meshbound
