// SPDX-License-Identifier: MIT
/// How far a texture moves on the surface when one mesh takes the place of another, after Cohen, Olano, Manocha,
/// "Appearance-Preserving Simplification", SIGGRAPH 1998.
///
///     d(x)    = min over the points y of B that have the texture coordinate of x of |x - y|
///     T(A,B)  = sup over the points x of A whose texture coordinate some point of B has of d(x)
///
/// What B does not cover is measured apart: it has no such distance.
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "meshbound/attributes.h"
#include "meshbound/bounds.h"
#include "meshbound/distance.h"
#include "meshbound/stop_token.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound {

/// A triangle with texture coordinates. Nothing is assumed of it: it may have no area in space or in the texture.
struct TexturedTriangle {
  std::array<Eigen::Vector3d, 3> corners;  ///< model units
  /// Texture coordinates u, v at the corners, linear between them. Flags can take the alignment of Eigen away, hence
  /// this one: see `Pose`.
  alignas(16) std::array<Eigen::Vector2d, 3> coordinates;
  std::uint32_t triangle = 0;  ///< index in the mesh that it comes from
  /// Coordinates are equal only where these are: the number of the material, or 0 for all.
  std::uint32_t material = 0;

  [[nodiscard]] bool operator==(const TexturedTriangle&) const = default;  ///< equality of all members
};

/// A mesh as its texture sees it.
struct TexturedMesh {
  std::vector<TexturedTriangle> triangles;           ///< those that have texture coordinates at all corners
  std::vector<std::array<Eigen::Vector3d, 3>> bare;  ///< corners of those that do not

  [[nodiscard]] bool operator==(const TexturedMesh&) const = default;  ///< equality of all triangles
};

/// Two meshes with the texture coordinates of their attributes, both rounded to the precision of the first and then to
/// that of the second: where charts adjoin in the texture, what lies beside a border would otherwise be compared with
/// another chart, as far away as that is on the surface, by as little as the rounding of a file. Where both have
/// materials, coordinates of different materials are different, materials being the same by their name. Throws
/// `InvalidInput` where a mesh has no texture coordinates, or attributes are not those of as many triangles. O(n).
[[nodiscard]] std::array<TexturedMesh, 2> textured_meshes(const TriangleMesh& a, const MeshAttributes& a_attributes,
                                                          const TriangleMesh& b, const MeshAttributes& b_attributes);

/// What is asked of a measurement of texture deviation.
struct TextureDeviationOptions {
  /// Wanted width of the interval, model units. Absent: 1e-6 of the diagonal of A's bounding box; of the box around
  /// both meshes where A is a point.
  std::optional<double> error_bound;
  /// When given, model units: each triangle is refined until it is decided whether it is within the tolerance, as far
  /// as the error bound and `max_pieces` allow; triangles not shown to be within are listed. One that is shown to be
  /// beyond is bounded no closer.
  std::optional<double> tolerance;
  std::uint64_t max_pieces = 100'000;  ///< largest number of pieces that a triangle is cut into
  int threads = 0;                     ///< 0: as many as OpenMP has. Results are the same for every value.
  StopToken stop = {};                 ///< the measurement ends with `Stopped` soon after this says so
};

/// A point, and the nearest of the points of the other mesh that have its texture coordinate.
struct TextureWitness {
  SurfacePoint from;     ///< on the mesh that is measured
  SurfacePoint nearest;  ///< on the other one
  /// The texture coordinate that both points have; aligned as in `TexturedTriangle`.
  alignas(16) Eigen::Vector2d coordinate = Eigen::Vector2d::Zero();
  double distance = 0;  ///< the length between the two, rounded to nearest
};

/// The deviation T(A, B) of one direction.
struct OneSidedTextureDeviation {
  /// Model units. 0 where no point of A has a texture coordinate that B covers: `uncovered` is 1 then.
  Bounds bounds;
  std::optional<TextureWitness> witness;  ///< realises `bounds.lower` up to rounding; absent where nothing is covered
  /// Share of the area of A, in space, whose texture coordinates B does not cover, or that has none. 0 to 1.
  Bounds uncovered;
  /// One point of each triangle of A that is not shown to be within the tolerance, where one was given.
  std::vector<TextureWitness> exceeding;
  /// `BudgetExhausted` where `max_pieces` came first, `ExceedsTolerance` where the interval is wide as it is beyond a
  /// tolerance.
  Outcome outcome = Outcome::Converged;
  std::uint64_t pairs = 0;   ///< of triangles whose texture coordinates were intersected
  std::uint64_t pieces = 0;  ///< pieces into which these intersections were cut
};

/// The deviation of both directions.
struct TextureDeviation {
  Bounds bounds;                    ///< the maximum of both directions, model units
  OneSidedTextureDeviation a_to_b;  ///< T(A, B)
  OneSidedTextureDeviation b_to_a;  ///< T(B, A)
};

/// Measures max(T(A, B), T(B, A)) to an interval of at most the error bound in each direction, or says by its outcome
/// that it could not. Charts may overlap, be mirrored or tiled: the nearest of all points with the coordinate counts.
/// Where triangles of B without area in the texture meet triangles of A with such an area, they add candidates on a
/// line or at a point of the texture only.
///
/// The intervals hold in real arithmetic: what doubles cannot decide is decided by integers of any length. Bounds are
/// the same for any number of threads. Throws `InvalidInput` for an error bound or tolerance that is negative or not a
/// number, and for coordinates that are not finite. Expected O((n + k) log n) for k pairs of triangles that meet in the
/// texture. Safe to call from several threads.
[[nodiscard]] TextureDeviation texture_deviation(const TexturedMesh& a, const TexturedMesh& b,
                                                 const TextureDeviationOptions& options = {});

/// The side of a texel on the surface, model units: the root of the area in space per area in the texture of the
/// triangles that have texture coordinates, divided by `texture_size`, the texels of a side of the square texture.
/// Infinite where no triangle has an area in the texture. Throws `InvalidInput` where `texture_size` is not positive.
/// O(n).
[[nodiscard]] double texel_length(const TexturedMesh& mesh, double texture_size);

}  // namespace meshbound
