// SPDX-License-Identifier: MIT
// glTF 2.0 and GLB: a new document for a mesh of another format; else the document that the mesh was read from, with
// new triangles and nothing else changed.
#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mesh/data_uri.h"
#include "mesh/file_bytes.h"
#include "mesh/gltf_attributes.h"
#include "mesh/gltf_buffer.h"
#include "mesh/gltf_content.h"
#include "mesh/gltf_document.h"
#include "mesh/gltf_primitives.h"
#include "mesh/gltf_references.h"
#include "mesh/no_value.h"
#include "mesh/split_vertices.h"
#include "mesh/writers.h"
#include "numeric/no_index.h"

namespace meshbound {
namespace {

/// How the properties of a primitive of the document are stored.
GltfLayout layout_of(const GltfJson& document, const GltfJson& primitive) {
  GltfLayout layout;
  visit_properties(primitive, [&](const std::string& name, const GltfJson& number) {
    if (name == "POSITION" || !number.is_number_unsigned()) return;
    const GltfJson& accessor = document["accessors"][number.get<std::size_t>()];
    const auto type = std::find(gltf_types.begin(), gltf_types.end(), accessor["type"].get<std::string>());
    layout[name] = {static_cast<GltfComponent>(accessor["componentType"].get<int>()),
                    accessor.value("normalized", false), static_cast<std::size_t>(type - gltf_types.begin()) + 1};
    if (target_property(name).semantic == "POSITION") layout[name] = {GltfComponent::Float, false, 3};
  });
  return layout;
}

/// The document of a mesh, with the triangles of a level in place of its own.
class DocumentEdit {
 public:
  DocumentEdit(const TriangleMesh& mesh, const MeshAttributes& attributes)
      : mesh_(mesh),
        attributes_(attributes),
        from_(*attributes.document),
        json_(from_.json),
        buffer_(json_, from_.buffers),
        triangles_of_(from_.parts.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) triangles_of_[attributes.part[t]].push_back(t);
  }

  GltfContent run() {
    choose_parts();
    std::vector<GltfLayout> layouts;
    for (const std::uint32_t part : replaced_) layouts.push_back(layout_of(json_, primitive(part)));
    buffer_.free_accessors(accessors_to_free());
    for (std::size_t i = 0; i < replaced_.size(); ++i) {
      const std::uint32_t part = replaced_[i];
      write_primitive(buffer_, primitive(part), mesh_, attributes_, triangles_of_[part],
                      from_.placed_of(part).placement, layouts[i]);
      remove_lists_of_vertices(json_, from_.placed_of(part).mesh, primitive(part));
    }
    for (const std::uint32_t part : emptied_) {
      leave_a_point(part);
      remove_lists_of_vertices(json_, from_.placed_of(part).mesh, primitive(part));
    }
    embed_images();
    std::string bytes = buffer_.finish();
    return {std::move(json_), std::move(bytes)};
  }

 private:
  GltfJson& primitive(std::uint32_t part) {
    return json_["meshes"][from_.placed_of(part).mesh]["primitives"][from_.parts[part].primitive];
  }

  /// Chooses the parts whose primitives are replaced or emptied: those of written copies that have triangles.
  void choose_parts() {
    const std::vector<std::uint32_t> written = from_.written_copies();
    for (std::uint32_t part = 0; part < from_.parts.size(); ++part) {
      const std::uint32_t placed = from_.parts[part].placed;
      if (written[placed] != placed || from_.parts[part].first_vertex == no_index) continue;
      (triangles_of_[part].empty() ? emptied_ : replaced_).push_back(part);
    }
  }

  /// Accessors to which only the replaced primitives refer.
  [[nodiscard]] std::vector<std::size_t> accessors_to_free() {
    std::vector<const GltfJson*> replaced;
    for (const std::uint32_t part : replaced_) replaced.push_back(&primitive(part));
    return accessors_used_only_by(replaced, json_);
  }

  /// Makes a primitive of which nothing is left one triangle without extent, at a vertex that it had. Primitives
  /// without triangles and meshes without primitives are not valid, and others keep their numbers, by which animations
  /// and extensions refer to them.
  void leave_a_point(std::uint32_t part) {
    const std::uint32_t v = from_.parts[part].first_vertex;
    primitive(part)["indices"] = buffer_.add_indices({{v, v, v}}, std::size_t{v} + 1);
    primitive(part).erase("mode");
  }

  /// Embeds images from files of their own, unchanged, so that the written file is complete wherever it is moved.
  void embed_images() {
    const auto images = json_.find("images");
    if (images == json_.end() || !images->is_array()) return;
    for (GltfJson& image : *images) {
      if (!image.is_object() || !image.contains("uri") || !image["uri"].is_string()) continue;
      const auto path = relative_path_of(image["uri"].get<std::string>());
      if (!path) continue;
      embed_image(image, from_.folder / *path);
    }
  }

  void embed_image(GltfJson& image, const std::filesystem::path& path) {
    try {
      const FileBytes file(path);
      const std::string type = image_type(file.bytes(), image, path);
      image["bufferView"] = buffer_.add_view(file.bytes(), 0, 0);
      image["mimeType"] = type;
      image.erase("uri");
    } catch (const IoError&) {
      // A missing image was missing for the original as well: its name stays.
    }
  }

  /// By the first bytes; of a kind that is unknown here as the file says, else by the ending of its name.
  static std::string image_type(std::string_view bytes, const GltfJson& image, const std::filesystem::path& path) {
    if (bytes.starts_with("\x89PNG")) return "image/png";
    if (bytes.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
    if (bytes.starts_with("\xABKTX 20")) return "image/ktx2";
    if (bytes.starts_with("RIFF") && bytes.substr(0, 12).ends_with("WEBP")) return "image/webp";
    if (bytes.substr(0, 12).ends_with("ftypavif")) return "image/avif";
    if (bytes.starts_with("DDS ")) return "image/vnd-ms.dds";
    const std::string ending = path.extension().string();
    return image.value("mimeType", "image/" + (ending.size() > 1 ? ending.substr(1) : "unknown"));
  }

  const TriangleMesh& mesh_;
  const MeshAttributes& attributes_;
  const GltfDocument& from_;
  GltfJson json_;
  GltfBuffer buffer_;
  std::vector<std::vector<std::uint32_t>> triangles_of_;  ///< by part
  std::vector<std::uint32_t> replaced_, emptied_;         ///< parts
};

/// Attributes of other formats under names that glTF allows: "COLOR_0", or an underscore and capitals, each once.
MeshAttributes named_for_gltf(const MeshAttributes& attributes) {
  MeshAttributes result = attributes;
  std::set<std::string> names;
  for (NamedAttribute& named : result.named) {
    if (named.name == "COLOR_0") continue;
    std::string name = "_";
    for (const char c : named.name) {
      const bool is_small = c >= 'a' && c <= 'z', is_allowed = (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
      name += is_small ? static_cast<char>(c - 'a' + 'A') : is_allowed ? c : '_';
    }
    named.name = name;
    for (int number = 2; !names.insert(named.name).second; ++number) named.name = name + '_' + std::to_string(number);
  }
  return result;
}

/// What the triangles of a primitive have in common: the material or `no_value`, then whether they have a value at each
/// corner, by attribute.
using PrimitiveKey = std::vector<std::uint32_t>;

PrimitiveKey primitive_key(const MeshAttributes& attributes, std::uint32_t triangle) {
  const auto has = [&](const std::vector<Triangle>& index) -> std::uint32_t {
    return !index.empty() && all_have_values(index[triangle]);
  };
  PrimitiveKey key = {attributes.materials.empty() ? no_value : attributes.materials.index[triangle],
                      has(attributes.normals.index), has(attributes.texture_coordinates.index)};
  for (const NamedAttribute& named : attributes.named) key.push_back(has(named.index));
  return key;
}

/// A document of one node for a mesh of another format: one primitive for the triangles of each material that have
/// values of the same attributes.
GltfContent new_document(const TriangleMesh& mesh, const MeshAttributes& given) {
  const MeshAttributes attributes = named_for_gltf(given);
  GltfLayout layout;
  if (!attributes.normals.empty()) layout["NORMAL"] = {GltfComponent::Float, false, 3};
  if (!attributes.texture_coordinates.empty()) layout["TEXCOORD_0"] = {GltfComponent::Float, false, 2};
  for (const NamedAttribute& named : attributes.named) {
    const bool in_bytes = named.name.starts_with("COLOR_") && holds_bytes(named);
    layout[named.name] = {in_bytes ? GltfComponent::UInt8 : GltfComponent::Float, in_bytes, named.width};
  }
  GltfJson json = {{"asset", {{"version", "2.0"}, {"generator", "meshbound"}}},
                   {"scene", 0},
                   {"scenes", GltfJson::array({{{"nodes", GltfJson::array({0})}}})},
                   {"nodes", GltfJson::array({{{"mesh", 0}}})}};
  std::map<PrimitiveKey, std::vector<std::uint32_t>> triangles_of;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) triangles_of[primitive_key(attributes, t)].push_back(t);
  const std::vector<std::string> no_buffers;
  GltfBuffer buffer(json, no_buffers);
  GltfJson primitives = GltfJson::array();
  for (const auto& [key, triangles] : triangles_of) {
    const std::uint32_t material = key.front();
    GltfJson primitive = GltfJson::object();
    write_primitive(buffer, primitive, mesh, attributes, triangles, {}, layout);
    if (material != no_value) primitive["material"] = material;
    primitives.push_back(std::move(primitive));
  }
  json["meshes"] = GltfJson::array({{{"primitives", std::move(primitives)}}});
  for (const std::string& name : attributes.materials.names)
    json["materials"].push_back({{"name", name}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}});
  std::string bytes = buffer.finish();
  return {std::move(json), std::move(bytes)};
}

/// The JSON as UTF-8; invalid bytes in names are replaced.
std::string text_of(const GltfJson& json) { return json.dump(-1, ' ', false, GltfJson::error_handler_t::replace); }

void write_glb(AtomicFile& file, std::string text, std::string_view bytes) {
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t size = 12 + 8 + text.size() + (bytes.empty() ? 0 : 8 + bytes.size());
  if (size > std::numeric_limits<std::uint32_t>::max())
    throw InvalidInput(file.path().string() + ": a GLB file holds at most 4 GiB; write PLY");
  file.write("glTF");
  put_little_endian(file, std::uint32_t{2});
  put_little_endian(file, static_cast<std::uint32_t>(size));
  put_little_endian(file, static_cast<std::uint32_t>(text.size()));
  file.write("JSON");
  file.write(text);
  if (bytes.empty()) return;
  put_little_endian(file, static_cast<std::uint32_t>(bytes.size()));
  file.write(std::string_view("BIN\0", 4));
  file.write(bytes);
}

}  // namespace

InvalidInput malformed_origin(const GltfJson::exception& error) {
  return InvalidInput(std::string("the JSON of the glTF file that the mesh comes from is malformed: ") + error.what());
}

GltfContent gltf_content(const TriangleMesh& mesh, const MeshAttributes& attributes) {
  try {
    return attributes.document ? DocumentEdit(mesh, attributes).run() : new_document(mesh, attributes);
  } catch (const GltfJson::exception& error) {
    throw malformed_origin(error);
  }
}

void write_gltf(AtomicFile& file, FileFormat format, const TriangleMesh& mesh, const MeshAttributes& attributes) {
  write_gltf(file, format, gltf_content(mesh, attributes));
}

void write_gltf(AtomicFile& file, FileFormat format, GltfContent content) {
  if (format == FileFormat::Glb) return write_glb(file, text_of(content.json), content.bytes);
  if (!content.bytes.empty())
    content.json["buffers"][0]["uri"] = "data:application/octet-stream;base64," + encode_base64(content.bytes);
  file.write(text_of(content.json));
}

}  // namespace meshbound
