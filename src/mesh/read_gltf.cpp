// SPDX-License-Identifier: MIT
// glTF 2.0 and GLB (https://registry.khronos.org/glTF/specs/2.0/glTF-2.0.html): the triangles of the default scene.
#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/gltf_attributes.h"
#include "mesh/gltf_document.h"
#include "mesh/gltf_scene.h"
#include "mesh/mesh_assembler.h"
#include "mesh/readers.h"
#include "mesh/round_to_floats.h"
#include "mesh/weld.h"
#include "meshbound/triangle_mesh.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// Triangles of a primitive with this drawing mode, from the vertex of each corner.
std::vector<Triangle> triangles_of(const std::vector<std::uint32_t>& corners, std::size_t mode) {
  std::vector<Triangle> triangles;
  const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const bool joins_runs = mode != GltfMode::triangles && (a == b || b == c || c == a);
    if (!joins_runs) triangles.push_back({a, b, c});
  };
  const std::size_t step = mode == GltfMode::triangles ? 3 : 1;
  for (std::size_t i = 0; i + 2 < corners.size(); i += step) {
    if (mode == GltfMode::fan)
      add(corners[i + 1], corners[i + 2], corners[0]);
    else if (mode == GltfMode::strip && i % 2 == 1)
      add(corners[i], corners[i + 2], corners[i + 1]);
    else
      add(corners[i], corners[i + 1], corners[i + 2]);
  }
  return triangles;
}

class GltfReader {
 public:
  GltfReader(const MeshSource& source, std::shared_ptr<GltfDocument> document)
      : source_(source),
        document_(std::move(document)),
        root_(source, document_->json),
        accessors_(source, *document_),
        assembler_(source, Position::Byte) {
    if (source.with_attributes) attributes_.emplace(accessors_, root_);
  }

  /// The triangles of these meshes; nothing where they have none and `may_be_empty` is set.
  std::optional<MeshFile> read(std::vector<PlacedMesh> placed, bool may_be_empty) {
    document_->parts.clear();
    document_->placed = std::move(placed);
    for (std::uint32_t i = 0; i < document_->placed.size(); ++i) read_placed(i);
    if (may_be_empty && !assembler_.has_triangles()) return std::nullopt;
    if (!attributes_) {
      assembler_.dropped().materials = root_.count("materials");
      assembler_.dropped().scene_objects = count_scene_objects(*document_);
    }
    MeshFile file = assembler_.finish();
    file.decoded_strips = decoded_strips_;
    file.rest_pose_parts = rest_pose_parts_;
    if (attributes_) {
      file.attributes = attributes_->finish();
      document_->other_elements = std::exchange(file.dropped.other_elements, 0);
      file.attributes.document = std::move(document_);
    }
    return file;
  }

 private:
  void read_placed(std::uint32_t number) {
    const std::uint32_t mesh_number = document_->placed[number].mesh;
    const GltfValue mesh = root_.at("meshes").item(mesh_number);
    vertex_of_.clear();
    welder_ = Welder();
    first_vertex_ = static_cast<std::uint32_t>(assembler_.vertex_count());
    const std::uint32_t object = attributes_ ? attributes_->add_object(mesh, mesh_number) : 0;
    const GltfValue primitives = mesh.at("primitives");
    for (std::uint32_t i = 0; i < primitives.size(); ++i) {
      const GltfValue primitive = primitives.item(i);
      const std::size_t mode = primitive.integer_or("mode", GltfMode::triangles);
      if (mode < GltfMode::triangles || mode > GltfMode::fan || !primitive.at("attributes").find("POSITION"))
        assembler_.ignore_element();
      else
        read_primitive(primitive, mode, number, i, object);
    }
  }

  void read_primitive(const GltfValue& primitive, std::size_t mode, std::uint32_t placed, std::uint32_t number,
                      std::uint32_t object) {
    const GltfValue where = primitive.at("attributes").at("POSITION");
    const std::size_t accessor = where.index(root_.count("accessors"), "accessors");
    const GltfAccessor& positions = accessors_.at(accessor);
    if (positions.numbers.width != 3) where.fail("the positions are not of three numbers");
    const NodePlacement placement = document_->placed[placed].placement;
    document_->parts.push_back({placed, number, no_index});
    if (attributes_)
      attributes_->begin_primitive(primitive, placement, static_cast<std::uint32_t>(document_->parts.size() - 1),
                                   object, positions.count);
    else
      count_attributes(primitive, positions.count, assembler_.dropped());
    if (document_->placed[placed].has_skin || primitive.count("targets") > 0) ++rest_pose_parts_;
    if (mode != GltfMode::triangles) ++decoded_strips_;
    const bool is_mirrored = placement.is_mirrored();
    for (Triangle t : triangles_of(corners_of(primitive, positions.count), mode)) {
      if (document_->parts.back().first_vertex == no_index) document_->parts.back().first_vertex = t[0];
      if (is_mirrored) std::swap(t[1], t[2]);
      Triangle corners;
      for (std::size_t k = 0; k < 3; ++k) corners[k] = vertex(where, accessor, positions, placed, t[k]);
      assembler_.add_polygon(corners);
      if (attributes_) attributes_->add_triangle(t);
    }
  }

  std::vector<std::uint32_t> corners_of(const GltfValue& primitive, std::size_t vertices) {
    std::vector<std::uint32_t> corners;
    const auto indices = primitive.find("indices");
    if (!indices) {
      for (std::uint32_t i = 0; i < vertices; ++i) corners.push_back(i);
      return corners;
    }
    const GltfAccessor& accessor = accessors_.at(indices->index(root_.count("accessors"), "accessors"));
    if (accessor.numbers.width != 1 || accessor.numbers.component == GltfComponent::Float)
      indices->fail("the indices are not single integers");
    for (const double value : accessor.values) {
      if (!(value >= 0 && value < static_cast<double>(vertices)))
        indices->fail("a triangle refers to vertex " + std::to_string(static_cast<std::int64_t>(value)) +
                      ", but the primitive has only " + std::to_string(vertices) + " (counted from 0)");
      corners.push_back(static_cast<std::uint32_t>(value));
    }
    return corners;
  }

  /// The vertex of the mesh for a vertex of the primitive; vertices of one node at equal positions become one.
  std::uint32_t vertex(const GltfValue& where, std::size_t accessor, const GltfAccessor& positions,
                       std::uint32_t placed, std::uint32_t number) {
    std::vector<std::uint32_t>& known = vertex_of_[accessor];
    if (known.empty()) known.assign(positions.count, no_index);
    if (known[number] != no_index) return known[number];
    const double* const from = positions.values.data() + std::size_t{3} * number;
    // Viewers round the quotient of a normalised integer to a float; all other components are floats already.
    const Eigen::Vector3d local = rounded_to_float(Eigen::Vector3d(from[0], from[1], from[2]));
    if (!local.allFinite()) where.fail("the position of vertex " + std::to_string(number) + " is not finite");
    PlacedMesh& shown = document_->placed[placed];
    shown.reach = std::max(shown.reach, local.cwiseAbs().maxCoeff());
    const Eigen::Vector3d p = shown.placement.to_scene(local);
    const std::uint32_t welded = first_vertex_ + welder_.index_of(p);
    if (welded == assembler_.vertex_count()) assembler_.add_vertex(p, source_.bytes.size());
    return known[number] = welded;
  }

  const MeshSource& source_;
  std::shared_ptr<GltfDocument> document_;
  GltfValue root_;
  AccessorCache accessors_;
  MeshAssembler assembler_;
  std::optional<GltfAttributes> attributes_;
  std::size_t decoded_strips_ = 0, rest_pose_parts_ = 0;

  // What belongs to the placed mesh that is read:
  std::map<std::size_t, std::vector<std::uint32_t>> vertex_of_;  ///< by accessor of positions and vertex
  Welder welder_;
  std::uint32_t first_vertex_ = 0;
};

void add_camera(const GltfValue& root, const PlacedCamera& shown, GltfScene& scene) {
  const GltfValue number = root.at("nodes").item(shown.node).at("camera");
  const GltfValue camera = root.at("cameras").item(number.index(root.count("cameras"), "cameras"));
  if (camera.at("type").text() != "perspective") {
    ++scene.orthographic_cameras;
    return;
  }
  const GltfValue view = camera.at("perspective"), angle = view.at("yfov");
  if (!(angle.number() > 0 && angle.number() < std::numbers::pi)) angle.fail("expected radians between 0 and pi");
  GltfScene::Camera& added = scene.cameras.emplace_back();
  added.node = shown.node;
  added.placement = shown.placement;
  added.vertical_field_of_view = angle.number();
  if (const auto ratio = view.find("aspectRatio")) {
    if (!(ratio->number() > 0)) ratio->fail("expected a positive number");
    added.aspect_ratio = ratio->number();
  }
}

}  // namespace

MeshFile read_gltf(const MeshSource& source) {
  auto document = std::make_shared<GltfDocument>(read_gltf_document(source));
  std::vector<PlacedMesh> placed = placed_objects(source, *document).meshes;
  return *GltfReader(source, std::move(document)).read(std::move(placed), false);
}

GltfScene read_gltf_scene(const MeshSource& source) {
  const auto document = std::make_shared<GltfDocument>(read_gltf_document(source));
  const PlacedObjects placed = placed_objects(source, *document);
  GltfScene scene;
  std::map<std::uint32_t, std::size_t> index_of;  // of a mesh in `scene`; `no_mesh`: it has no triangles
  constexpr std::size_t no_mesh = no_index;
  for (const PlacedMesh& shown : placed.meshes) {
    const auto [found, is_new] = index_of.try_emplace(shown.mesh, no_mesh);
    if (is_new) {
      PlacedMesh in_own_frame = shown;
      in_own_frame.placement = {};
      auto content = GltfReader(source, document).read({in_own_frame}, true);
      if (content) {
        found->second = scene.meshes.size();
        scene.meshes.push_back({shown.mesh, *std::move(content)});
      }
    }
    if (found->second != no_mesh) scene.instances.push_back({found->second, shown.node, shown.placement});
  }
  const GltfValue root(source, document->json);
  for (const PlacedCamera& shown : placed.cameras) add_camera(root, shown, scene);
  return scene;
}

}  // namespace meshbound
