// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/gltf_value.h"
#include "meshbound/io.h"

namespace meshbound {

/// Where a node places its mesh: x -> linear x + translation.
struct NodePlacement {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  [[nodiscard]] bool is_identity() const { return linear.isIdentity(0) && translation.isZero(0); }
  /// A viewer turns the triangles of a mirrored mesh over, so that they still face outwards.
  [[nodiscard]] bool is_mirrored() const;
  /// False where the mesh is flattened, also one that a scale of 0 hides: nothing placed tells where it was.
  [[nodiscard]] bool is_invertible() const;
  [[nodiscard]] Eigen::Vector3d to_scene(const Eigen::Vector3d& p) const;
  [[nodiscard]] Eigen::Vector3d to_node(const Eigen::Vector3d& p) const;  ///< needs `is_invertible`
  /// A placement inside a placement.
  [[nodiscard]] NodePlacement operator*(const NodePlacement& inner) const;
};

/// A mesh of the document as a node of the default scene shows it.
struct PlacedMesh {
  std::uint32_t mesh = 0;
  std::uint32_t node = 0;
  NodePlacement placement;
  bool has_skin = false;  ///< joints move it; it is read where it is without them
};

/// A primitive of triangles of a placed mesh: what one number of `MeshAttributes::part` stands for.
struct GltfPart {
  std::uint32_t placed = 0;  ///< of `GltfDocument::placed`
  std::uint32_t primitive = 0;
};

/// A glTF file beyond the triangles that were read from it: all of its JSON and of its buffers, and where the parts of
/// the mesh stand in it. Never changed once it is read.
struct GltfDocument {
  GltfJson json;
  std::vector<std::string> buffers;
  std::vector<PlacedMesh> placed;
  std::vector<GltfPart> parts;
  std::filesystem::path folder;  ///< where relative names of image files begin

  [[nodiscard]] const PlacedMesh& placed_of(std::uint32_t part) const { return placed[parts[part].placed]; }
};

/// The JSON and the buffers of a file, `placed` and `parts` still empty. The version must be 2, the JSON not nested too
/// deeply to be written again, each buffer as long as it says, and no extension required that is unknown here and may
/// change triangles. Throws `InvalidInput`, and `IoError` where a file of a buffer cannot be read.
[[nodiscard]] GltfDocument read_gltf_document(const MeshSource& source);

/// Textures, cameras, animations and skins.
[[nodiscard]] std::size_t count_scene_objects(const GltfDocument& document);

/// The meshes that the default scene shows, in the order of its nodes: the scene of number `scene`, else the first one,
/// else all nodes that are no children. Throws `InvalidInput`, also where a node has two parents.
[[nodiscard]] std::vector<PlacedMesh> placed_meshes(const MeshSource& source, const GltfDocument& document);

/// Properties of the vertices of a primitive, "POSITION" and the like.
enum class GltfComponent { Int8 = 5120, UInt8 = 5121, Int16 = 5122, UInt16 = 5123, UInt32 = 5125, Float = 5126 };

[[nodiscard]] std::size_t size_of(GltfComponent component);

/// How the numbers of an accessor are stored.
struct GltfNumbers {
  GltfComponent component = GltfComponent::Float;
  bool normalized = false;  ///< integers stand for numbers from 0 or -1 to 1
  std::size_t width = 1;    ///< numbers in an element
};

/// An accessor and all its numbers, sparse ones put in place. Integers are exact; a normalised one is the quotient.
struct GltfAccessor {
  GltfNumbers numbers;
  std::size_t count = 0;       ///< elements
  std::vector<double> values;  ///< `numbers.width` for each element
};

/// Reads `accessors[index]`. Throws `InvalidInput` where it reaches beyond its buffer, is compressed, or has elements
/// that are matrices. Never allocates more than the file can justify.
[[nodiscard]] GltfAccessor read_accessor(const MeshSource& source, const GltfDocument& document, std::size_t index);

}  // namespace meshbound
