// SPDX-License-Identifier: MIT
#include "simplify/cover/loop_cover.h"

namespace meshbound {
void LoopCover::set_tolerance(double tolerance, double magnitude) {
  tolerance_ = tolerance;
  walk_.set_tolerance(tolerance, magnitude);
}

void LoopCover::append(const Walk& walk, bool forward) {
  for (std::size_t i = 0; i < walk.count; ++i) append(faces_[walk.begin + (forward ? i : walk.count - 1 - i)]);
}

void LoopCover::list_faces(std::vector<std::uint32_t>& faces) const {
  for (std::size_t i = 0; i < loop_size_; ++i)
    if (std::find(faces.begin(), faces.end(), loop_[i]) == faces.end()) faces.push_back(loop_[i]);
}

/// Whether the loop around triangle `t` can be contracted.
bool LoopCover::contracts(std::uint32_t t) {
  const auto first_with = [&](const auto& may_go) {
    std::size_t before = loop_size_ - 1, i = 0;
    for (; i < loop_size_; before = i++)
      if (may_go(loop_[before], loop_[i], loop_[i + 1 == loop_size_ ? 0 : i + 1])) break;
    return i;
  };
  while (loop_size_ > 2) {
    std::size_t gone = first_with(
        [](std::uint32_t before, std::uint32_t face, std::uint32_t after) { return before == after || face == after; });
    if (gone == loop_size_)
      gone = first_with([&](std::uint32_t before, std::uint32_t face, std::uint32_t after) {
        return have_near_vertex({before, face, after}, t);
      });
    if (gone == loop_size_) return false;
    std::copy(loop_.begin() + gone + 1, loop_.begin() + loop_size_, loop_.begin() + gone);
    --loop_size_;
  }
  return true;  // the ends of two parts are in both N
}

/// Whether these faces have a vertex in common that is within the tolerance of triangle `t`.
bool LoopCover::have_near_vertex(const std::array<std::uint32_t, 3>& faces, std::uint32_t t) const {
  const auto has = [&](std::uint32_t face, std::uint32_t vertex) {
    return mesh_.vertex(3 * face) == vertex || mesh_.vertex(3 * face + 1) == vertex ||
           mesh_.vertex(3 * face + 2) == vertex;
  };
  for (Corner c = 3 * faces[0]; c < 3 * faces[0] + 3; ++c) {
    const std::uint32_t vertex = mesh_.vertex(c);
    if (!has(faces[1], vertex) || !has(faces[2], vertex)) continue;
    const Vec3 p = vertices_[triangles_[t][0]], q = vertices_[triangles_[t][1]], r = vertices_[triangles_[t][2]];
    if (PreparedTriangle({p, q - p, r - p}).is_within(mesh_.position(vertex), tolerance_ * tolerance_)) return true;
  }
  return false;
}

}  // namespace meshbound
