// SPDX-License-Identifier: MIT
#include "mesh/gltf_primitives.h"

#include <algorithm>
#include <charconv>
#include <string_view>

#include "mesh/no_value.h"
#include "mesh/round_to_floats.h"
#include "mesh/split_vertices.h"

namespace meshbound {
namespace {

class PrimitiveWriter {
 public:
  PrimitiveWriter(GltfBuffer& buffer, const TriangleMesh& mesh, const MeshAttributes& attributes,
                  const std::vector<std::uint32_t>& triangles, const NodePlacement& placement, const GltfLayout& layout)
      : buffer_(buffer), mesh_(mesh), attributes_(attributes), placement_(placement), layout_(layout) {
    std::vector<const std::vector<Triangle>*> indices;
    if (is_kept("NORMAL")) indices.push_back(&attributes.normals.index);
    if (is_kept("TEXCOORD_0")) indices.push_back(&attributes.texture_coordinates.index);
    for (const NamedAttribute& named : attributes.named)
      if (is_kept(named.name)) indices.push_back(&named.index);
    vertices_ = split_vertices(mesh, triangles, indices);
  }

  void write(GltfJson& primitive) {
    primitive["attributes"] = GltfJson::object();
    GltfJson targets = GltfJson::array();
    put(primitive["attributes"]["POSITION"], {GltfComponent::Float, false, 3}, positions(), true);
    if (is_kept("NORMAL") && has_all(attributes_.normals.index))
      put(primitive["attributes"]["NORMAL"], layout_.at("NORMAL"), normals(), false);
    if (is_kept("TEXCOORD_0") && has_all(attributes_.texture_coordinates.index))
      put(primitive["attributes"]["TEXCOORD_0"], layout_.at("TEXCOORD_0"), texture_coordinates(), false);
    for (const NamedAttribute& named : attributes_.named) {
      if (!is_kept(named.name) || !has_all(named.index)) continue;
      const TargetProperty target = target_property(named.name);
      if (target.target < 0) {
        put(primitive["attributes"][named.name], layout_.at(named.name), values(named), false);
      } else {
        const auto number = static_cast<std::size_t>(target.target);
        while (targets.size() <= number) targets.push_back(GltfJson::object());
        put(targets[number][target.semantic], layout_.at(named.name), values(named), target.semantic == "POSITION");
      }
    }
    if (targets.empty())
      primitive.erase("targets");
    else
      primitive["targets"] = std::move(targets);
    primitive["indices"] = buffer_.add_indices(turned(), vertices_.corners.size());
    primitive.erase("mode");
  }

 private:
  [[nodiscard]] bool is_kept(const std::string& name) const { return layout_.contains(name); }

  [[nodiscard]] bool has_all(const std::vector<Triangle>& index) const {
    for (std::size_t v = 0; v < vertices_.corners.size(); ++v)
      if (vertices_.value(index, v) == no_value) return false;
    return true;
  }

  void put(GltfJson& place, const GltfNumbers& numbers, const std::vector<double>& values, bool with_range) {
    place = buffer_.add_accessor(numbers, values, with_range);
  }

  [[nodiscard]] std::vector<double> positions() const {
    std::vector<double> result;
    for (std::size_t v = 0; v < vertices_.corners.size(); ++v) {
      const Eigen::Vector3d p = written_position(placement_, mesh_.vertices[vertices_.source(mesh_, v)]);
      result.insert(result.end(), p.begin(), p.end());
    }
    return result;
  }

  /// In the frame of the node. The reader maps normals by the transposed inverse of the placement, so the writer undoes
  /// that.
  [[nodiscard]] std::vector<double> normals() const {
    std::vector<double> result;
    for (std::size_t v = 0; v < vertices_.corners.size(); ++v) {
      const Eigen::Vector3d& n = attributes_.normals.values[vertices_.value(attributes_.normals.index, v)];
      Eigen::Vector3d local = placement_.is_identity() ? n : Eigen::Vector3d(placement_.linear.transpose() * n);
      local.normalize();
      if (!(local.norm() > 0)) local = Eigen::Vector3d::UnitZ();  // glTF knows no normal of length 0
      result.insert(result.end(), local.begin(), local.end());
    }
    return result;
  }

  [[nodiscard]] std::vector<double> texture_coordinates() const {
    const CornerAttribute& from = attributes_.texture_coordinates;
    std::vector<double> result;
    for (std::size_t v = 0; v < vertices_.corners.size(); ++v) {
      const Eigen::Vector3d& uv = from.values[vertices_.value(from.index, v)];
      result.push_back(uv.x());
      result.push_back(1 - uv.y());
    }
    return result;
  }

  [[nodiscard]] std::vector<double> values(const NamedAttribute& named) const {
    const std::size_t width = layout_.at(named.name).width;
    std::vector<double> result;
    for (std::size_t v = 0; v < vertices_.corners.size(); ++v) {
      const std::size_t first = vertices_.value(named.index, v) * named.width;
      for (std::size_t k = 0; k < width; ++k) result.push_back(k < named.width ? named.values[first + k] : 1);
    }
    if (named.name == "WEIGHTS_0" && !is_kept("WEIGHTS_1") && layout_.at(named.name).component == GltfComponent::Float)
      scale_to_sum_one(result, width);
    return result;
  }

  /// The weights of a vertex must have sum 1; many files do not keep to that.
  static void scale_to_sum_one(std::vector<double>& weights, std::size_t width) {
    for (std::size_t first = 0; first + width <= weights.size(); first += width) {
      double sum = 0;
      for (std::size_t k = 0; k < width; ++k) sum += weights[first + k];
      for (std::size_t k = 0; sum > 0 && k < width; ++k) weights[first + k] /= sum;
    }
  }

  /// The triangles with their corners in the order of the file: the reader has turned those of a mirrored node over, as
  /// viewers do.
  [[nodiscard]] std::vector<Triangle> turned() const {
    std::vector<Triangle> triangles = vertices_.triangles;
    if (placement_.is_mirrored())
      for (Triangle& t : triangles) std::swap(t[1], t[2]);
    return triangles;
  }

  GltfBuffer& buffer_;
  const TriangleMesh& mesh_;
  const MeshAttributes& attributes_;
  const NodePlacement& placement_;
  const GltfLayout& layout_;
  SplitVertices vertices_;
};

}  // namespace

void write_primitive(GltfBuffer& buffer, GltfJson& primitive, const TriangleMesh& mesh,
                     const MeshAttributes& attributes, const std::vector<std::uint32_t>& triangles,
                     const NodePlacement& placement, const GltfLayout& layout) {
  PrimitiveWriter(buffer, mesh, attributes, triangles, placement, layout).write(primitive);
}

Eigen::Vector3d written_position(const NodePlacement& placement, const Eigen::Vector3d& p) {
  return rounded_to_float(placement.to_node(p));
}

TargetProperty target_property(const std::string& name) {
  constexpr std::string_view prefix = "targets/";
  TargetProperty result;
  const std::size_t slash = name.find('/', prefix.size());
  if (!name.starts_with(prefix) || slash == std::string::npos) return result;
  const char* const end = name.data() + slash;
  const auto parsed = std::from_chars(name.data() + prefix.size(), end, result.target);
  if (parsed.ec != std::errc() || parsed.ptr != end) return {};
  result.semantic = name.substr(slash + 1);
  return result;
}

}  // namespace meshbound
