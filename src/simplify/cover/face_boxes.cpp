// SPDX-License-Identifier: MIT
#include "simplify/cover/face_boxes.h"

#include <algorithm>

#include "geometry/boxes.h"

namespace meshbound {

template <class IsWanted>
void FaceBoxes::take_faces(const ArrayMesh& mesh, const IsWanted& is_wanted) {
  for (std::uint32_t f = 0; f < mesh.face_count(); ++f)
    if (!mesh.is_removed(f) && is_wanted(f)) faces_.push_back(f);
  std::vector<Eigen::AlignedBox3d> boxes;
  boxes.reserve(faces_.size());
  for (const std::uint32_t f : faces_) boxes.push_back(box_of(mesh.triangle(f)));
  tree_.emplace(boxes);
}

FaceBoxes::FaceBoxes(const ArrayMesh& mesh) {
  take_faces(mesh, [](std::uint32_t) { return true; });
}

FaceBoxes::FaceBoxes(const ArrayMesh& mesh, const BoxTree& wanted) {
  take_faces(mesh, [&](std::uint32_t face) { return wanted.meets(box_of(mesh.triangle(face))); });
}

void FaceBoxes::find(const Eigen::AlignedBox3d& box, std::vector<std::uint32_t>& found) const {
  const std::size_t before = found.size();
  tree_->find(box, found);
  for (std::size_t i = before; i < found.size(); ++i) found[i] = faces_[found[i]];
}

bool FaceBoxes::find_few(const Eigen::AlignedBox3d& box, std::size_t max_count,
                         std::vector<std::uint32_t>& found) const {
  BoxTree::Search search(*tree_, box);
  for (std::size_t count = 0;; ++count) {
    const std::optional<std::uint32_t> index = search.next();
    if (!index) return true;
    if (count == max_count) return false;
    found.push_back(faces_[*index]);
  }
}

void FaceBoxes::find_nearest(const ArrayMesh& mesh, Vec3 point, double limit, std::size_t max_count,
                             std::vector<NearFace>& nearest) const {
  nearest.clear();
  const auto is_nearer = [](const NearFace& a, const NearFace& b) {
    return a.squared < b.squared || (a.squared == b.squared && a.face < b.face);
  };
  const double squared_limit = limit * limit;
  std::size_t looked_at = 0;
  tree_->visit_near(to_eigen(point), squared_limit, [&](std::uint32_t index) {
    const std::uint32_t face = faces_[index];
    if (!mesh.is_removed(face)) {
      const NearFace found{squared_distance(mesh.triangle(face), point), face};
      if (nearest.size() < max_count && found.squared <= squared_limit) {
        nearest.push_back(found);
        std::push_heap(nearest.begin(), nearest.end(), is_nearer);
      } else if (nearest.size() == max_count && is_nearer(found, nearest.front())) {
        std::pop_heap(nearest.begin(), nearest.end(), is_nearer);
        nearest.back() = found;
        std::push_heap(nearest.begin(), nearest.end(), is_nearer);
      }
      if (++looked_at == max_looked_at) return BoxTree::end_of_visit;
    }
    return nearest.size() == max_count ? nearest.front().squared : squared_limit;
  });
  std::sort_heap(nearest.begin(), nearest.end(), is_nearer);
}

}  // namespace meshbound
