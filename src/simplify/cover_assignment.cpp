// SPDX-License-Identifier: MIT
#include "simplify/cover_assignment.h"

#include <algorithm>

namespace meshbound {
namespace {

bool contains(std::span<const std::uint32_t> ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

void remove_from(CoverAssignment::Ids& ids, std::uint32_t id) {
  const auto at = std::find(ids.begin(), ids.end(), id);
  *at = ids.back();
  ids.pop_back();
  if (ids.empty()) CoverAssignment::Ids().swap(ids);  // faces that vanish must not keep memory
}

}  // namespace

void CoverAssignment::assign(std::uint32_t original, std::span<const std::uint32_t> faces) {
  const std::span<const std::uint32_t> current = faces_of(original);
  for (const std::uint32_t face : current) {
    if (!contains(faces, face)) remove_from(originals_of_[face], original);
  }
  for (const std::uint32_t face : faces) {
    if (contains(current, face)) continue;
    reserve_face(face);
    originals_of_[face].push_back(original);
  }
  store(faces_of_[original], faces);
}

void CoverAssignment::store(Faces& at, std::span<const std::uint32_t> faces) {
  const bool was_many = at.size > Faces::room, is_many = faces.size() > Faces::room;
  if (was_many && !is_many) unused_.push_back(at.ids[0]);
  if (is_many && !was_many) {
    if (unused_.empty()) {
      unused_.push_back(static_cast<std::uint32_t>(many_.size()));
      many_.emplace_back();
    }
    at.ids[0] = unused_.back();
    unused_.pop_back();
  }
  at.size = static_cast<std::uint32_t>(faces.size());
  if (is_many)
    many_[at.ids[0]].assign(faces.begin(), faces.end());
  else
    std::copy(faces.begin(), faces.end(), at.ids.begin());
}

}  // namespace meshbound
