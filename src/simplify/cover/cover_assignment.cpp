// SPDX-License-Identifier: MIT
#include "simplify/cover/cover_assignment.h"

#include <algorithm>

#include "numeric/sort_unique.h"

namespace meshbound {
namespace {

bool contains(std::span<const std::uint32_t> ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

void CoverAssignment::replace(std::uint32_t original, std::span<const std::uint32_t> faces, Ids& left) {
  const std::span<const std::uint32_t> current = faces_of(original);
  for (const std::uint32_t face : current)
    if (!contains(faces, face) && (left.empty() || left.back() != face)) left.push_back(face);
  for (const std::uint32_t face : faces) {
    if (contains(current, face)) continue;
    reserve_faces(std::size_t{face} + 1);
    originals_of_[face].add(original);
  }
  faces_of_[original].assign(faces);
}

void CoverAssignment::remove_from_lists(Ids& left) {
  sort_unique(left);
  for (const std::uint32_t face : left)
    originals_of_[face].keep_if([&](std::uint32_t original) { return contains(faces_of(original), face); });
}

}  // namespace meshbound
