// SPDX-License-Identifier: MIT
/// Refuses collapses that would move the texture too far, by the samples around them.
#pragma once
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "geometry/triangle_corners.h"
#include "numeric/no_index.h"
#include "simplify/texture/nearest_with_coordinate.h"
#include "simplify/texture/texture_map.h"

namespace meshbound {

/// The faces around the edge of a collapse.
struct TexturedStar {
  Corner edge = 0;
  std::span<const Corner> moved;           ///< of faces that stay: the corner that moves
  std::span<const std::uint32_t> removed;  ///< faces that go
};

/// Chooses the texture coordinates of the vertex that a collapse leaves, and compares the samples around with the faces
/// as they would be: the distance between points of equal texture coordinates, after Cohen, Olano, Manocha,
/// "Appearance-Preserving Simplification", SIGGRAPH 1998. Each thread needs its own.
///
/// A vertex placed at an end of the edge takes the coordinates of that end, on each side of a line its own. At any
/// other place it starts with the coordinate that the mesh has there; where the samples exceed the limit, Newton's
/// method on the sum of the sixth powers of their distances moves it.
class TextureGuard {
 public:
  TextureGuard(const TextureMap& map, const ArrayMesh& mesh, const FeatureLines& lines)
      : map_(map), mesh_(mesh), lines_(lines) {}

  /// Starts anew with these faces, which must stay as they are until the next call. O(samples).
  void begin(const TexturedStar& star);
  /// Whether the samples stay within the limit of the map with the vertex at `point`. O(samples * faces).
  [[nodiscard]] bool holds(Vec3 point);
  /// How far the texture would have moved at the placement that was refused last, in limits: a guess, seldom more than
  /// the truth; 0 where no sample has refused it.
  [[nodiscard]] float deviation() const {
    return exceeding_squared_ > 0 ? static_cast<float>(std::sqrt(exceeding_squared_) / map_.limit) : 0;
  }
  /// Another star follows, of which nothing is known yet: without `begin` and `holds` nothing is written for it.
  void forget() { accepted_ = false; }
  /// Writes the coordinates that `holds` accepted last to the faces that stay.
  void apply(TextureMap& map) const;
  /// Assigns the samples of the star to the faces that stay, as `holds` has matched them. Call once the mesh has
  /// collapsed.
  void give_samples(TextureMap& map) const;

 private:
  /// A face that stays, as it would be.
  struct Face {
    TriangleCorners at;
    CornerCoordinates coordinates;
    std::uint32_t chart = no_index, number = 0;
    // These are set where the face has an area in the texture.
    /// Maps a coordinate, relative to that of the vertex, to the weights of the two other corners.
    Eigen::Matrix2d to_weights;
    /// Derivative D of a position in the face by the texture coordinate there, in limits, and its square D^T D: uu, uv,
    /// vv.
    std::array<Vec3, 2> derivative;
    std::array<double, 3> squared_derivative;
    bool has_area = false, has_one_coordinate = false;
    LineCoordinates line;  ///< set where the face has no area in the texture
  };
  /// The point of a face that a sample is compared with.
  struct Match {
    std::uint32_t face = no_index;  ///< index in `faces_`
    bool is_inside = false;
    std::array<double, 3> weights{};
    Vec3 offset;  ///< from the sample to that point
  };
  struct EdgeOfFace {
    std::size_t face, number;  ///< index in `faces_`, and of the corner where it starts
  };
  /// Derivatives of a sum by the coordinate of the vertex: of the sixth powers of the samples' distances, in limits.
  struct Slope {
    std::array<double, 2> gradient{};
    std::array<double, 3> curvature{};  ///< uu, uv, vv
  };

  [[nodiscard]] bool set_faces(Vec3 point);
  void set_at_end(std::uint32_t stays, std::uint32_t leaves);
  void set_sector(Corner of_leaving, const Eigen::Vector2d& coordinate);
  [[nodiscard]] std::optional<Eigen::Vector2d> coordinate_at(Vec3 point) const;
  [[nodiscard]] bool is_turned_over() const;
  void prepare_faces();
  void put_few_first();
  [[nodiscard]] bool has_many() const;
  [[nodiscard]] bool are_near(std::size_t count);
  [[nodiscard]] bool match(std::size_t count, double max_squared);
  [[nodiscard]] bool match_inside(const TextureMap::Sample& sample, std::uint32_t number, Match& match) const;
  [[nodiscard]] bool matches_again(const TextureMap::Sample& sample, Match& match) const;
  [[nodiscard]] bool suffices(const Match& match) const;
  [[nodiscard]] Match match(const TextureMap::Sample& sample, std::uint32_t chart) const;
  [[nodiscard]] Match match_outside(const TextureMap::Sample& sample, std::uint32_t chart) const;
  void add_slope(const Face& face, const Match& match, Slope& sum) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> newton_step(std::size_t count) const;
  [[nodiscard]] double worst_squared(std::size_t count) const;
  [[nodiscard]] bool improve(std::size_t count);
  void move_to(const Eigen::Vector2d& coordinate);
  void find_lines();
  [[nodiscard]] bool are_borders_free();
  [[nodiscard]] bool is_border_free(std::size_t sample);
  [[nodiscard]] bool is_strip_free(const TextureMap::Sample& sample, const Eigen::Vector2d& nearest,
                                   std::uint32_t material);
  [[nodiscard]] bool has_no_far_point(const Eigen::Vector2d& coordinate, std::uint32_t material, Vec3 p);
  [[nodiscard]] bool are_uncovered_free();
  [[nodiscard]] double squared_deviation(const Face& face, const std::array<double, 3>& weights);
  [[nodiscard]] bool is_edge_near(const EdgeOfFace& edge);
  [[nodiscard]] bool are_faces_near();
  [[nodiscard]] bool are_lines_near();
  [[nodiscard]] bool becomes_line(std::size_t face, std::size_t k) const;

  const TextureMap& map_;
  const ArrayMesh& mesh_;
  const FeatureLines& lines_;
  TexturedStar star_;
  std::vector<std::uint32_t> samples_, charts_;  ///< of the star: its samples, and the chart of each
  std::vector<Face> faces_;                      ///< by moved corner; the moving vertex comes first
  std::vector<double> area_before_;  ///< by moved corner: twice the area of the face in the texture before the collapse
  std::vector<Match> matches_, matches_before_;  ///< by sample: the last match, and that before the last Newton step
  bool is_free_ = false;                         ///< the vertex has a single coordinate, which may be changed
  bool accepted_ = false;                        ///< the faces are those of a placement that holds
  double exceeding_squared_ = 0;                 ///< the squared distance of a sample for which a placement was refused
  std::vector<EdgeOfFace> of_lines_;             ///< edges of the faces that are lines, or become lines
  std::vector<EdgeOfFace> doubtful_;             ///< edges of the faces that must be looked at closely
  std::vector<std::uint32_t> found_;
};

/// Assigns the samples of faces that an undone collapse has just restored to those of them that have their coordinates.
void give_back_samples(TextureMap& map, const ArrayMesh& mesh, std::span<const std::uint32_t> faces);

}  // namespace meshbound
