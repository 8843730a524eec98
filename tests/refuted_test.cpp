// SPDX-License-Identifier: MIT
// Whether what was refuted still is, after changes around it were undone.
#include <gtest/gtest.h>

#include <algorithm>

#include "numeric/numbers_below.h"
#include "simplify/mesh/manifold_soup.h"
#include "simplify/normals/refuted_turns.h"
#include "simplify/texture/refuted_texture.h"

namespace meshbound {
namespace refuted_test {

/// A square of 4 x 4 squares at height 0, whose texture coordinates are x and y.
class Square : public testing::Test {
 protected:
  Square() {
    for (int y = 0; y < 5; ++y)
      for (int x = 0; x < 5; ++x) vertices_.push_back({double(x), double(y), 0});
    for (std::uint32_t y = 0; y < 4; ++y) {
      for (std::uint32_t x = 0; x < 4; ++x) {
        const std::uint32_t v = 5 * y + x;
        triangles_.push_back({v, v + 1, v + 6});
        triangles_.push_back({v, v + 6, v + 5});
      }
    }
    TriangleMesh square;
    for (const Vec3& p : vertices_) square.vertices.emplace_back(p.x, p.y, p.z);
    square.triangles = triangles_;
    const ManifoldSoup soup = manifold_soup(square);
    std::vector<Vec3> points;
    for (const std::uint32_t v : soup.vertex_of) points.push_back(vertices_[v]);
    mesh_.emplace(std::move(points), soup.faces, soup.twin);
    faces_ = numbers_below(mesh_->face_count());
  }

  /// Moves the vertex in the middle, at (2, 2), up to this height; it has six faces.
  void lift(double height) { mesh_->move(middle(), {2, 2, height}); }
  [[nodiscard]] std::uint32_t middle() const {
    for (std::uint32_t v = 0;; ++v)
      if (mesh_->position(v).x == 2 && mesh_->position(v).y == 2) return v;
  }
  [[nodiscard]] bool is_around(std::uint32_t face) const {
    const auto corners = mesh_->corners(face);
    return std::find(corners.begin(), corners.end(), middle()) != corners.end();
  }
  [[nodiscard]] std::uint32_t face_around() const {
    return *std::find_if(faces_.begin(), faces_.end(), [this](std::uint32_t f) { return is_around(f); });
  }

  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
  std::optional<ArrayMesh> mesh_;
  std::vector<std::uint32_t> faces_;
};

class RefutedByTexture : public Square {
 protected:
  RefutedByTexture() {
    std::vector<CornerCoordinates> coordinates;
    for (const Triangle& t : triangles_) {
      CornerCoordinates& corners = coordinates.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) corners[k] = {vertices_[t[k]].x, vertices_[t[k]].y};
    }
    lines_ = FeatureLines(*mesh_, std::vector<std::uint8_t>(3 * mesh_->face_count(), 0));
    map_.emplace(Atlas(vertices_, triangles_, coordinates, {}), *mesh_, lines_, faces_, vertices_, triangles_, 1.0);
    map_->limit = 0.5;
  }
  [[nodiscard]] std::vector<Refuted> left(const Refuted& refuted, std::span<const std::uint32_t> changed) const {
    return refuted_by_texture(*map_, *mesh_, std::vector{refuted}, changed);
  }

  FeatureLines lines_;
  std::optional<TextureMap> map_;
  const Eigen::Vector2d at_ = {2.1, 2.05};  ///< in one of the six faces
};

TEST_F(RefutedByTexture, AsksForAFaceNearThePointOfTheOriginal) {
  const Refuted refuted{20, no_index, at_};
  lift(0.5);
  EXPECT_TRUE(left(refuted, faces_).empty());
  lift(0.6);
  ASSERT_EQ(left(refuted, faces_).size(), 1U);
  EXPECT_EQ(left(refuted, faces_)[0].original, refuted.original);
  EXPECT_EQ(left(refuted, faces_)[0].coordinate, refuted.coordinate);
}

TEST_F(RefutedByTexture, LooksOnlyAtFacesThatHaveChanged) {
  std::vector<std::uint32_t> elsewhere;
  for (const std::uint32_t f : faces_)
    if (!is_around(f)) elsewhere.push_back(f);
  EXPECT_EQ(left({20, no_index, at_}, elsewhere).size(), 1U);
  EXPECT_TRUE(left({no_index, 0, at_}, elsewhere).empty());
}

TEST_F(RefutedByTexture, NamesTheFaceThatIsTooFarNow) {
  lift(0.5);
  EXPECT_TRUE(left({no_index, 0, at_}, faces_).empty());
  lift(0.6);
  const std::vector<Refuted> found = left({no_index, 0, at_}, faces_);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].original, no_index);
  EXPECT_TRUE(is_around(found[0].face));
}

TEST_F(RefutedByTexture, LeavesOutWhatHasTurnedAndWhatIsNoFace) {
  lift(5);
  EXPECT_TRUE(left({no_index, no_index, at_}, faces_).empty());
  EXPECT_TRUE(left({20, face_around(), std::nullopt}, faces_).empty());
}

class RefutedByTurns : public Square {
 protected:
  [[nodiscard]] std::vector<Refuted> left(const Refuted& refuted) const {
    return refuted_by_turns(turns_, *mesh_, faces_, faces_.size(), std::vector{refuted});
  }
  FaceTurns turns_{*mesh_, std::vector<std::uint8_t>(mesh_->face_count(), 0), {30, 1, 1}};
};

/// A vertex lifted by h turns the faces around it by atan(h) or, those with two edges to it along x and y, by
/// atan(sqrt(2) h): 30 degrees are 0.577 and 0.408.
TEST_F(RefutedByTurns, ComparesWithTheFaceThatTheSampleBelongsTo) {
  const Refuted refuted{.original = face_around(), .face = no_index};
  EXPECT_TRUE(left(refuted).empty());
  lift(0.4);
  EXPECT_TRUE(left(refuted).empty());
  lift(0.6);
  ASSERT_EQ(left(refuted).size(), 1U);
  EXPECT_EQ(left(refuted)[0].original, refuted.original);
}

/// A face from elsewhere lies flat over one that has turned, nearer to where that was.
TEST_F(RefutedByTurns, ComparesWithTheFaceThatWasFoundWhereThatIsNearer) {
  const std::uint32_t around = face_around();
  const std::uint32_t found = *std::find_if(faces_.begin(), faces_.end(), [&](std::uint32_t f) {
    const auto corners = mesh_->corners(f), taken = mesh_->corners(around);
    return std::find_first_of(corners.begin(), corners.end(), taken.begin(), taken.end()) == corners.end();
  });
  const std::array<Vec3, 3> place = mesh_->triangle(around);
  lift(1);
  for (std::size_t k = 0; k < 3; ++k) mesh_->move(mesh_->corners(found)[k], place[k] + Vec3{0, 0, 0.01});
  EXPECT_EQ(left({around, no_index}).size(), 1U);
  EXPECT_TRUE(left({around, found}).empty());
  for (const std::uint32_t v : mesh_->corners(found)) mesh_->move(v, mesh_->position(v) + Vec3{0, 0, 2});
  EXPECT_EQ(left({around, found}).size(), 1U);
}

/// Each face stands for an original with twice its number plus 100; those between are none.
TEST_F(RefutedByTurns, LeavesOutOriginalsThatAreNoFace) {
  lift(5);
  std::vector<std::uint32_t> source_triangle;
  for (const std::uint32_t f : faces_) source_triangle.push_back(2 * f + 100);
  const std::uint32_t original = 2 * face_around() + 100;
  const std::vector<Refuted> all{{original, no_index}, {original + 1, no_index}, {3, no_index}};
  const std::vector<Refuted> left = refuted_by_turns(turns_, *mesh_, source_triangle, 200, all);
  ASSERT_EQ(left.size(), 1U);
  EXPECT_EQ(left[0].original, original);
}

TEST_F(RefutedByTurns, LeavesOutFacesAndTexture) {
  lift(5);
  EXPECT_TRUE(left({no_index, face_around()}).empty());
  EXPECT_TRUE(left({face_around(), no_index, Eigen::Vector2d(2, 2)}).empty());
}

}  // namespace refuted_test
}  // namespace meshbound
