// SPDX-License-Identifier: MIT
#include "simplify/kernel/sample_kernel.h"

namespace meshbound {
namespace {

Vec<float> rounded(Vec3 v) { return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)}; }
float reciprocal(float x) { return x > 0 ? 1 / x : 0; }

}  // namespace

SampleFace::SampleFace(Vec3 corner, Vec3 second, Vec3 third)
    : a(rounded(corner)), ab(rounded(second - corner)), ac(rounded(third - corner)) {
  ab_ab = dot(ab, ab);
  ab_ac = dot(ab, ac);
  ac_ac = dot(ac, ac);
  by_area = reciprocal(ab_ab * ac_ac - ab_ac * ab_ac);
  by_ab = reciprocal(ab_ab);
  by_ac = reciprocal(ac_ac);
  by_bc = reciprocal(ab_ab - 2 * ab_ac + ac_ac);
}

void note_shared_sides(std::span<SampleFace> faces) {
  const auto same = [](const Vec<float>& u, const Vec<float>& v) { return u.x == v.x && u.y == v.y && u.z == v.z; };
  for (std::size_t i = 0; i < faces.size(); ++i) {
    SampleFace& face = faces[i];
    for (std::size_t k = 1; k < faces.size() && !face.shares_ac; ++k) {
      const SampleFace& other = faces[(i + k) % faces.size()];
      face.shares_ac = same(face.ac, other.ab) && same(face.a, other.a);
    }
  }
}

void DeviationSums::add(Vec3 offset, double share) {
  const double squared = squared_length(offset), fourth = squared * squared;
  const double o[3] = {offset.x, offset.y, offset.z};
  sum += fourth * squared;
  if (squared > worst_squared) worst_squared = squared;
  for (int k = 0; k < 3; ++k) {
    gradient[k] -= 6 * share * fourth * o[k];
    curvature[k] += 30 * share * share * squared * o[k] * o[k];
    curvature[3 + k] += 30 * share * share * squared * o[k] * o[(k + 1) % 3];
  }
}

}  // namespace meshbound
