// SPDX-License-Identifier: MIT
// Whether triangles meet: the quick answers of doubles against the exact ones.
#include "penetration/contact.h"

#include <gtest/gtest.h>

#include <cstdint>

#include "model_data.h"
#include "reference/small_meshes.h"

namespace contact_test {

using namespace meshbound;
using namespace meshbound::reference;

TEST(TrianglesCross, IsTriangleMeetingWhereNoVertexIsShared) {
  for (const double size : {0.05, 0.5}) {
    const ClosedModel::Data model = test::model_data(random_soup(5, 300, size));
    PlacedPair pair;
    pair.place(model, Eigen::Isometry3d::Identity(), model, Eigen::Isometry3d::Identity());
    const auto corners = [&](std::uint32_t t) {
      const auto& [p, q, r] = model.triangles[t];
      return PairTriangle{{{0, p}, {0, q}, {0, r}}};
    };
    std::size_t meeting = 0;
    for (std::uint32_t t = 0; t < model.triangles.size(); ++t) {
      for (std::uint32_t s = 0; s < t; ++s) {
        const bool meets = triangles_meet(pair, corners(s), corners(t));
        ASSERT_EQ(triangles_cross(pair, model.triangles[s], model.triangles[t]), meets) << s << " " << t;
        meeting += meets ? 1 : 0;
      }
    }
    EXPECT_GT(meeting, 0U);
  }
}

}  // namespace contact_test
