// SPDX-License-Identifier: MIT
// Vertices that planes have cut off from their neighbours go to the tile of most of these.
#include "tiles/tile_borders.h"

#include <gtest/gtest.h>

#include "numeric/no_index.h"

namespace meshbound {
namespace tile_borders_test {

/// Vertex 0 with a triangle to each two neighbours of 1, 2, 3, 4.
const std::vector<Triangle> fan = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}};
const std::vector<std::uint32_t> light(6, 1);

TEST(TileBorders, GiveTheMiddleOfAFanToTheTileOfItsRim) {
  std::vector<std::uint32_t> owner = {0, 1, 1, 1, 1, 0};
  smooth_tile_borders(fan, light, 100, owner);
  EXPECT_EQ(owner, (std::vector<std::uint32_t>{1, 1, 1, 1, 1, 0}));
}

TEST(TileBorders, LeaveNoTileTooHeavyOrEmpty) {
  std::vector<std::uint32_t> owner = {0, 1, 1, 1, 1, 0};
  smooth_tile_borders(fan, light, 4, owner);
  EXPECT_EQ(owner[0], 0U) << "tile 1 has its weight already";
  owner = {0, 1, 1, 1, 1, 1};
  smooth_tile_borders(fan, light, 100, owner);
  EXPECT_EQ(owner[0], 0U) << "tile 0 has no other vertex";
}

TEST(TileBorders, StayWhereNoOtherTileHasMoreOfTheVerticesAround) {
  const std::vector<Triangle> two_at_a_vertex = {{0, 1, 2}, {0, 3, 4}};
  for (const std::uint32_t of_middle : {0U, 1U}) {
    std::vector<std::uint32_t> owner = {of_middle, 0, 0, 1, 1};
    smooth_tile_borders(two_at_a_vertex, light, 100, owner);
    EXPECT_EQ(owner, (std::vector<std::uint32_t>{of_middle, 0, 0, 1, 1}));
  }
}

TEST(TileBorders, LookAtVerticesOfTilesOnly) {
  std::vector<std::uint32_t> owner = {no_index, 1, 1, 0, 0, 0};
  smooth_tile_borders(fan, light, 100, owner);
  EXPECT_EQ(owner[0], no_index);
  owner = {0, no_index, no_index, 1, no_index, 0};
  smooth_tile_borders(fan, light, 100, owner);
  EXPECT_EQ(owner[0], 1U);
  EXPECT_EQ(owner[1], no_index);
}

}  // namespace tile_borders_test
}  // namespace meshbound
