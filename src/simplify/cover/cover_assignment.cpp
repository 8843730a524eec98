// SPDX-License-Identifier: MIT
#include "simplify/cover/cover_assignment.h"

#include <algorithm>

namespace meshbound {
namespace {

bool contains(std::span<const std::uint32_t> ids, std::uint32_t id) {
  return std::find(ids.begin(), ids.end(), id) != ids.end();
}

}  // namespace

void CoverAssignment::Faces::set(std::span<const std::uint32_t> faces) {
  const bool has_room = size_ == faces.size() || faces.size() <= few_.size();
  std::uint32_t* const list = has_room ? nullptr : new std::uint32_t[faces.size()];
  if (size_ != faces.size()) free();
  size_ = static_cast<std::uint32_t>(faces.size());
  if (list != nullptr) std::memcpy(few_.data(), &list, sizeof(list));
  std::copy(faces.begin(), faces.end(), is_many() ? many() : few_.data());
}

void CoverAssignment::replace(std::uint32_t original, std::span<const std::uint32_t> faces, Ids& left) {
  const std::span<const std::uint32_t> current = faces_of(original);
  for (const std::uint32_t face : current)
    if (!contains(faces, face) && (left.empty() || left.back() != face)) left.push_back(face);
  for (const std::uint32_t face : faces) {
    if (contains(current, face)) continue;
    reserve_face(face);
    originals_of_[face].push_back(original);
  }
  faces_of_[original].set(faces);
}

void CoverAssignment::remove_from_lists(Ids& left) {
  std::sort(left.begin(), left.end());
  left.erase(std::unique(left.begin(), left.end()), left.end());
  for (const std::uint32_t face : left) {
    Ids& ids = originals_of_[face];
    std::erase_if(ids, [&](std::uint32_t original) { return !contains(faces_of(original), face); });
    if (ids.empty()) Ids().swap(ids);  // faces that vanish must not keep memory
  }
}

}  // namespace meshbound
