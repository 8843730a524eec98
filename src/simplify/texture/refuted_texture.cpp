// SPDX-License-Identifier: MIT
#include "simplify/texture/refuted_texture.h"

#include <optional>

#include "simplify/cover/box_tree.h"
#include "simplify/texture/weighted_points.h"

namespace meshbound {
namespace {

/// Faces of the mesh, found by a texture coordinate.
class FacesInTexture {
 public:
  FacesInTexture(const TextureMap& texture, const ArrayMesh& mesh, std::span<const std::uint32_t> faces)
      : texture_(texture), mesh_(mesh), faces_(faces), tree_(boxes()) {}

  /// Calls visit(face, point) for each face with this coordinate and its point there.
  template <class Visit>
  void for_each_point(const Eigen::Vector2d& coordinate, std::uint32_t material, const Visit& visit) {
    found_.clear();
    const Eigen::Vector3d at(coordinate.x(), coordinate.y(), material);
    tree_.find({at, at}, found_);
    for (const std::uint32_t i : found_)
      if (const auto weights = weights_inside(texture_.of(faces_[i]), coordinate))
        visit(faces_[i], point_of(mesh_.triangle(faces_[i]), *weights));
  }

 private:
  [[nodiscard]] std::vector<Eigen::AlignedBox3d> boxes() const {
    std::vector<Eigen::AlignedBox3d> boxes(faces_.size());
    for (std::size_t i = 0; i < faces_.size(); ++i)
      if (!mesh_.is_removed(faces_[i])) boxes[i] = box_in_texture(texture_.of(faces_[i]), texture_.material(faces_[i]));
    return boxes;
  }

  const TextureMap& texture_;
  const ArrayMesh& mesh_;
  std::span<const std::uint32_t> faces_;
  BoxTree tree_;
  std::vector<std::uint32_t> found_;
};

}  // namespace

std::vector<Refuted> refuted_by_texture(const TextureMap& texture, const ArrayMesh& mesh,
                                        std::span<const Refuted> refuted, std::span<const std::uint32_t> changed) {
  std::vector<Refuted> left;
  std::vector<std::uint32_t> found;
  const double squared_limit = texture.limit * texture.limit;
  FacesInTexture faces(texture, mesh, changed);
  for (const Refuted& r : refuted) {
    const bool is_of_original = r.original != no_index;
    if (!r.coordinate || (!is_of_original && r.face == no_index)) continue;
    const std::uint32_t material = is_of_original ? texture.atlas().material(r.original) : texture.material(r.face);
    const auto point = is_of_original ? texture.atlas().point(r.original, *r.coordinate) : std::nullopt;
    bool is_shown = !point;
    faces.for_each_point(*r.coordinate, material, [&](std::uint32_t face, Vec3 at) {
      if (point)
        is_shown = is_shown || squared_length(at - *point) <= squared_limit;
      else if (texture.atlas().squared_distance(*r.coordinate, material, at, texture.limit, found) > squared_limit)
        left.push_back({no_index, face, r.coordinate});
    });
    if (!is_shown) left.push_back(r);
  }
  return left;
}

}  // namespace meshbound
