// SPDX-License-Identifier: MIT
#include "simplify/cover/cover_assignment.h"

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
  Faces& at = faces_of_[original];
  if (at.size == faces.size() && at.size > 1) {
    std::copy(faces.begin(), faces.end(), at.many);
    return;
  }
  std::uint32_t* many = nullptr;
  if (faces.size() > 1) {
    many = new std::uint32_t[faces.size()];
    std::copy(faces.begin(), faces.end(), many);
  }
  if (at.size > 1) delete[] at.many;
  at.size = static_cast<std::uint32_t>(faces.size());
  if (many != nullptr)
    at.many = many;
  else if (!faces.empty())
    at.only = faces[0];
}

}  // namespace meshbound
