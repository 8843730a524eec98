// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/gltf_value.h"
#include "mesh/scene_layout.h"
#include "meshbound/io.h"

namespace meshbound {

/// A glTF file beyond the triangles that were read from it: its whole JSON, its buffers, and where the parts of the
/// mesh stand in it. Immutable once read.
struct GltfDocument : SceneLayout {
  GltfJson json;
  std::vector<std::string> buffers;
  std::filesystem::path folder;    ///< image files are named relative to it
  std::size_t other_elements = 0;  ///< `MeshFile::ignored_elements`, which stay in the document
};

/// The JSON and the buffers of a file, compressed data decoded, `placed` and `parts` still empty. The version must be
/// 2, the JSON not nested too deeply to be written again, each buffer as long as it says, and no extension required
/// that is unknown here and may change triangles. Throws `InvalidInput`, and `IoError` where a file of a buffer cannot
/// be read.
[[nodiscard]] GltfDocument read_gltf_document(const MeshSource& source);

/// The files that a glTF file is read together with: those of its buffers and images. None where the file is of another
/// format, or is no glTF or cannot be read: reading it tells why.
[[nodiscard]] std::vector<std::filesystem::path> files_beside(const std::filesystem::path& path);

/// The number of textures, cameras, lights, animations and skins.
[[nodiscard]] std::size_t count_scene_objects(const GltfDocument& document);

/// The number of materials that have more than a name and how they reflect: colours, textures, transparency.
[[nodiscard]] std::size_t count_described_materials(const GltfDocument& document);

/// A node of the default scene that has a camera, which looks along -z there. The camera itself is not looked at.
struct PlacedCamera {
  std::uint32_t node = 0;
  NodePlacement placement;
};

/// What the nodes of the default scene show, in their order.
struct PlacedObjects {
  std::vector<PlacedMesh> meshes;
  std::vector<PlacedCamera> cameras;
};

/// The objects of the default scene: the scene of number `scene`, else the first one, else all nodes that are no
/// children. Throws `InvalidInput`, also where a node has two parents.
[[nodiscard]] PlacedObjects placed_objects(const MeshSource& source, const GltfDocument& document);

/// The bytes that "buffer", "byteOffset" and "byteLength" of a value locate. Throws `InvalidInput` where they reach
/// beyond their buffer. `buffers` must outlive them.
[[nodiscard]] std::string_view bytes_of(const GltfValue& located, const std::vector<std::string>& buffers);

/// The "mode" of primitives that consist of triangles; one that names none has the first.
struct GltfMode {
  static constexpr std::size_t triangles = 4, strip = 5, fan = 6;
};

/// Properties of the vertices of a primitive, "POSITION" and the like.
enum class GltfComponent { Int8 = 5120, UInt8 = 5121, Int16 = 5122, UInt16 = 5123, UInt32 = 5125, Float = 5126 };

[[nodiscard]] std::size_t size_of(GltfComponent component);

/// The types of elements of one, two, three and four numbers.
inline constexpr std::array<const char*, 4> gltf_types = {"SCALAR", "VEC2", "VEC3", "VEC4"};

/// How the numbers of an accessor are stored.
struct GltfNumbers {
  GltfComponent component = GltfComponent::Float;
  bool normalized = false;  ///< integers stand for numbers from 0 or -1 to 1
  std::size_t width = 1;    ///< numbers in an element
};

/// How the numbers of an accessor of the document are stored. Throws `InvalidInput` where it has elements that are
/// matrices, or of a type that glTF 2 does not know.
[[nodiscard]] GltfNumbers numbers_of(const GltfValue& accessor);

/// An accessor with all its numbers, sparse substitutions applied. Integers are exact; a normalised integer is the
/// quotient in double precision.
struct GltfAccessor {
  GltfNumbers numbers;
  std::size_t count = 0;       ///< elements
  std::vector<double> values;  ///< `numbers.width` for each element
};

/// Reads `accessors[index]`. Throws `InvalidInput` where it reaches beyond its buffer or has elements that are
/// matrices. Never allocates more than the file can justify.
[[nodiscard]] GltfAccessor read_accessor(const MeshSource& source, const GltfDocument& document, std::size_t index);

}  // namespace meshbound
