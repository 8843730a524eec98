// SPDX-License-Identifier: MIT
#include "mesh/attribute_check.h"

#include <algorithm>
#include <string>

#include "mesh/no_value.h"
#include "mesh/scene_layout.h"
#include "meshbound/error.h"

namespace meshbound {
namespace {

class AttributeCheck {
 public:
  explicit AttributeCheck(std::size_t triangles) : triangles_(triangles) {}

  void corners(const std::vector<Triangle>& index, std::size_t values, const std::string& what) const {
    check_size(index.size(), what);
    for (const Triangle& corners : index)
      for (const std::uint32_t value : corners) check_number(value, values, what);
  }

  void labels(const std::vector<std::uint32_t>& index, std::size_t names, const std::string& what) const {
    check_size(index.size(), what);
    for (const std::uint32_t name : index) check_number(name, names, what);
  }

 private:
  void check_size(std::size_t size, const std::string& what) const {
    if (size != 0 && size != triangles_)
      throw InvalidInput("the attributes are not those of as many triangles: " + what + " of " + std::to_string(size) +
                         " triangles, where the mesh has " + std::to_string(triangles_));
  }
  static void check_number(std::uint32_t number, std::size_t count, const std::string& what) {
    if (number != no_value && number >= count)
      throw InvalidInput("an attribute refers to number " + std::to_string(number) + " of the " + what +
                         ", but there are only " + std::to_string(count));
  }

  std::size_t triangles_;
};

}  // namespace

void check_attributes(const MeshAttributes& attributes, std::size_t triangles) {
  const AttributeCheck check(triangles);
  check.corners(attributes.texture_coordinates.index, attributes.texture_coordinates.values.size(),
                "texture coordinates");
  check.corners(attributes.normals.index, attributes.normals.values.size(), "normals");
  for (const NamedAttribute& named : attributes.named) {
    if (named.width == 0) throw InvalidInput("the attribute " + named.name + " has values of no numbers");
    if (named.index.size() != triangles)
      throw InvalidInput("the attributes are not those of as many triangles: " + named.name);
    check.corners(named.index, named.values.size() / named.width, "values of " + named.name);
  }
  check.labels(attributes.materials.index, attributes.materials.names.size(), "materials");
  check.labels(attributes.objects.index, attributes.objects.names.size(), "objects");
  check.labels(attributes.groups.index, attributes.groups.names.size(), "groups");
  check.labels(attributes.smoothing_groups.index, attributes.smoothing_groups.names.size(), "smoothing groups");
  const SceneLayout* const layout = scene_layout(attributes);
  if (layout == nullptr) return;
  if (attributes.part.size() != triangles)
    throw InvalidInput("the attributes are not those of as many triangles: parts of the document");
  for (const std::uint32_t part : attributes.part)
    if (part >= layout->parts.size()) throw InvalidInput("a triangle belongs to no part of the document");
}

}  // namespace meshbound
