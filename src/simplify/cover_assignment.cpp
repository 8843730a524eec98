// SPDX-License-Identifier: MIT
#include "simplify/cover_assignment.h"

#include <algorithm>

namespace meshbound {
namespace {

bool contains(const CoverAssignment::Ids& ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

void remove_from(CoverAssignment::Ids& ids, std::uint32_t id) {
  const auto at = std::find(ids.begin(), ids.end(), id);
  *at = ids.back();
  ids.pop_back();
  if (ids.empty()) CoverAssignment::Ids().swap(ids);  // faces that vanish must not keep memory
}

}  // namespace

void CoverAssignment::assign(std::uint32_t original, Ids& faces) {
  Ids& current = faces_of_[original];
  for (const std::uint32_t face : current) {
    if (!contains(faces, face)) remove_from(originals_of_[face], original);
  }
  for (const std::uint32_t face : faces) {
    if (contains(current, face)) continue;
    reserve_face(face);
    originals_of_[face].push_back(original);
  }
  current.swap(faces);
}

}  // namespace meshbound
