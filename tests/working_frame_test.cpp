// SPDX-License-Identifier: MIT
#include "simplify/working_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace working_frame_test {

using Eigen::Vector3d;
using meshbound::WorkingFrame;
using Wide = Eigen::Matrix<long double, 3, 1>;

TEST(WorkingFrame, BringsAnyModelToSizeOneAroundTheOrigin) {
  for (const double size : {0x1p-1060, 1e-160, 1e-3, 1.0, 3e7, 1e155, 0x1p1000}) {
    const WorkingFrame frame(Eigen::AlignedBox3d(size * Vector3d(-1, -0.5, 0.25), size * Vector3d(1, 0.5, 0.75)));
    const double extent = frame.to_frame(size * Vector3d(1, 0.5, 0.75)).cwiseAbs().maxCoeff();
    EXPECT_GE(extent, 0.5) << size;
    EXPECT_LT(extent, 1) << size;
  }
}

TEST(WorkingFrame, KeepsPointsOfABoxWithoutExtent) {
  const Vector3d p(3, -7, 1e6);
  const WorkingFrame frame(Eigen::AlignedBox3d(p, p));
  EXPECT_EQ(frame.to_frame(p), Vector3d::Zero());
  EXPECT_EQ(frame.to_model(Vector3d::Zero()), p);
  EXPECT_EQ(frame.length_to_frame(0.25), 0.25);
}

TEST(WorkingFrame, MovesNoPointFurtherThanItSays) {
  // Both ways, against the same in long double, which is exact but for the last bits of a sum of very unequal numbers.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const double offset : {0.0, 1.0, 1e6, 1e12}) {
    const Vector3d middle(offset, -0.7 * offset, 0.1 * offset), half(0.9, 0.4, 0.3);
    const Eigen::AlignedBox3d box(middle - half, middle + half);
    const WorkingFrame frame(box);
    const Wide centre = frame.to_model(Vector3d::Zero()).cast<long double>();
    const long double unit_length = frame.length_to_frame(1);
    for (int i = 0; i < 2000; ++i) {
      const Vector3d direction(unit(random), unit(random), unit(random));
      const Vector3d p = (middle + half.cwiseProduct(direction)).cwiseMax(box.min()).cwiseMin(box.max());
      const Wide framed = (p.cast<long double>() - centre) * unit_length;
      ASSERT_LE((frame.to_frame(p).cast<long double>() - framed).norm(), frame.rounding()) << "offset " << offset;
      const Vector3d q = 0.9 * direction;
      const Wide back = (frame.to_model(q).cast<long double>() - centre) * unit_length;
      ASSERT_LE((back - q.cast<long double>()).norm(), frame.rounding()) << "offset " << offset;
    }
  }
}

}  // namespace working_frame_test
