// SPDX-License-Identifier: MIT
// The container of glTF 2.0 (Khronos, "glTF 2.0 Specification", sections 3 and 4.4): JSON and buffers.
#include "mesh/gltf_document.h"

#include <algorithm>
#include <array>
#include <optional>

#include "mesh/data_uri.h"
#include "mesh/file_bytes.h"
#include "mesh/gltf_compression.h"
#include "mesh/gltf_references.h"
#include "meshbound/error.h"
#include "meshbound/io.h"
#include "numeric/byte_order.h"

namespace meshbound {
namespace {

constexpr std::uint32_t chunk_json = 0x4E4F534A, chunk_binary = 0x004E4942;
constexpr std::size_t header_size = 12, chunk_header_size = 8;  // bytes

/// Deepest nesting of objects and arrays that is accepted: writing and copying JSON recurses once for each level.
constexpr std::size_t max_depth = 256;

/// Beginnings of the names of extensions that may be required and yet leave triangles as they are.
constexpr std::array<std::string_view, 19> harmless_extensions = {"KHR_materials_",
                                                                  "KHR_texture_",
                                                                  "EXT_texture_",
                                                                  "MSFT_texture_",
                                                                  "KHR_lights_",
                                                                  "EXT_lights_",
                                                                  "KHR_xmp",
                                                                  "MSFT_packing_",
                                                                  "KHR_mesh_quantization",
                                                                  "KHR_animation_pointer",
                                                                  "KHR_node_visibility",
                                                                  "KHR_node_hoverability",
                                                                  "KHR_interactivity",
                                                                  "KHR_audio_emitter",
                                                                  "EXT_structural_metadata",
                                                                  "EXT_instance_features",
                                                                  "AGI_articulations",
                                                                  "VRMC_vrm",
                                                                  "MSFT_lod"};

std::uint32_t word_at(std::string_view bytes, std::size_t offset) {
  return load_number<std::uint32_t>(bytes.data() + offset, std::endian::little);
}

/// The two chunks of a GLB file, or the whole text of a glTF file.
struct Container {
  std::string_view json;
  std::optional<std::string_view> binary;
};

Container read_container(const MeshSource& source) {
  const std::string_view bytes = source.bytes;
  if (!bytes.starts_with("glTF")) return {bytes.substr(source.begin), std::nullopt};
  if (bytes.size() < header_size) source.fail_at_byte(bytes.size(), "the file ends inside the header of GLB");
  if (word_at(bytes, 4) != 2)
    source.fail_at_byte(4, "version " + std::to_string(word_at(bytes, 4)) + " of GLB is not known, only 2 is");
  if (word_at(bytes, 8) > bytes.size())
    source.fail_at_byte(8, "the header declares " + std::to_string(word_at(bytes, 8)) + " bytes, but the file has " +
                               std::to_string(bytes.size()));
  Container container;
  for (std::size_t at = header_size; at < word_at(bytes, 8);) {
    if (bytes.size() - at < chunk_header_size || word_at(bytes, at) > bytes.size() - at - chunk_header_size)
      source.fail_at_byte(at, "a chunk of GLB reaches beyond the end of the file");
    const std::string_view chunk = bytes.substr(at + chunk_header_size, word_at(bytes, at));
    const std::uint32_t type = word_at(bytes, at + 4);
    if (at == header_size && type != chunk_json) source.fail_at_byte(at + 4, "the first chunk of GLB is not JSON");
    if (at == header_size) container.json = chunk;
    if (type == chunk_binary && !container.binary) container.binary = chunk;
    at += chunk_header_size + chunk.size();
  }
  return container;
}

void refuse_deep_nesting(const MeshSource& source, std::string_view text) {
  std::size_t depth = 0;
  bool in_text = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (in_text && c == '\\') {
      ++i;
    } else if (c == '"') {
      in_text = !in_text;
    } else if (!in_text && (c == '{' || c == '[')) {
      if (++depth > max_depth)
        source.fail("the JSON has more than " + std::to_string(max_depth) + " objects or arrays inside each other");
    } else if (!in_text && (c == '}' || c == ']') && depth > 0) {
      --depth;
    }
  }
}

GltfJson parse_json(const MeshSource& source, std::string_view text) {
  refuse_deep_nesting(source, text);
  const auto offset = static_cast<std::size_t>(text.data() - source.bytes.data());
  try {
    return GltfJson::parse(text);
  } catch (const GltfJson::parse_error& error) {
    source.fail_at_byte(offset + (error.byte > 0 ? error.byte - 1 : 0), "the JSON of glTF is malformed here");
  } catch (const GltfJson::exception&) {
    source.fail("the JSON of glTF is malformed");
  }
}

std::string bytes_at_uri(const MeshSource& source, const GltfValue& uri) {
  const std::string text = uri.text();
  if (is_data_uri(text)) {
    auto decoded = decode_data_uri(text);
    if (!decoded) uri.fail("the data URI is malformed, or not in base64");
    return *std::move(decoded);
  }
  const auto name = relative_path_of(text);
  if (!name) uri.fail(quote(text) + " is neither a data URI nor the relative name of a file");
  return std::string(FileBytes(source.path.parent_path() / *name, source.stop).bytes());
}

void read_buffers(const MeshSource& source, const GltfValue& root, std::optional<std::string_view> binary,
                  std::vector<std::string>& buffers) {
  for (std::size_t i = 0; i < root.count("buffers"); ++i) {
    source.end_if_stopped();
    const GltfValue buffer = root.at("buffers").item(i);
    const std::size_t size = buffer.at("byteLength").integer();
    const auto uri = buffer.find("uri");
    std::string bytes;
    const bool is_binary_chunk = i == 0 && binary && !uri;
    if (is_binary_chunk) {
      bytes = std::string(*binary);
    } else if (is_placeholder_buffer(root, buffer)) {
      buffers.emplace_back();
      continue;
    } else if (uri) {
      bytes = bytes_at_uri(source, *uri);
    } else {
      buffer.fail("the buffer has no 'uri', and the file no binary chunk for it");
    }
    if (bytes.size() < size)
      buffer.fail("the buffer declares " + std::to_string(size) + " bytes, but has only " +
                  std::to_string(bytes.size()));
    bytes.resize(size);
    buffers.push_back(std::move(bytes));
  }
}

void refuse_unknown_requirements(const GltfValue& root) {
  for (std::size_t i = 0; i < root.count("extensionsRequired"); ++i) {
    const GltfValue item = root.at("extensionsRequired").item(i);
    const std::string name = item.text();
    const bool is_harmless = std::any_of(harmless_extensions.begin(), harmless_extensions.end(),
                                         [&](std::string_view known) { return name.starts_with(known); });
    if (!is_harmless && !is_read_compression(name))
      item.fail("the file requires the extension " + quote(name) +
                ", which is not read; convert the file to one without it");
  }
}

void check_version(const GltfValue& root) {
  const std::string version = root.at("asset").at("version").text();
  if (!version.starts_with("2."))
    root.at("asset").fail("version " + quote(version) + " of glTF is not read, only 2 is");
}

/// The text of a glTF file, or that of the first chunk of a GLB file without what follows it.
std::string json_text_of(const std::filesystem::path& path) {
  constexpr std::size_t json_begin = header_size + chunk_header_size;
  const std::string begin(FileBytes(path, {}, json_begin).bytes());
  if (!begin.starts_with("glTF")) return std::string(FileBytes(path).bytes());
  if (begin.size() < json_begin) return {};
  return std::string(FileBytes(path, {}, word_at(begin, header_size), json_begin).bytes());
}

}  // namespace

std::vector<std::filesystem::path> files_beside(const std::filesystem::path& path) {
  std::vector<std::filesystem::path> files;
  try {
    const FileFormat format = format_of(path);
    if (format != FileFormat::Gltf && format != FileFormat::Glb) return files;
    const std::string text = json_text_of(path);
    const MeshSource source{path, text, text.starts_with("\xEF\xBB\xBF") ? std::size_t{3} : 0, {}};
    const GltfJson json = parse_json(source, source.bytes.substr(source.begin));
    const GltfValue root(source, json);
    for (const char* const list : {"buffers", "images"}) {
      for (std::size_t i = 0; i < root.count(list); ++i) {
        const auto uri = root.at(list).item(i).find("uri");
        if (!uri || is_data_uri(uri->text())) continue;
        if (const auto name = relative_path_of(uri->text())) files.push_back(path.parent_path() / *name);
      }
    }
  } catch (const Error&) {
    files.clear();
  }
  return files;
}

GltfDocument read_gltf_document(const MeshSource& source) {
  const Container container = read_container(source);
  GltfDocument document;
  document.folder = source.path.parent_path();
  document.json = parse_json(source, container.json);
  const GltfValue root(source, document.json);
  check_version(root);
  refuse_unknown_requirements(root);
  read_buffers(source, root, container.binary, document.buffers);
  decompress(source, document);
  return document;
}

std::size_t count_scene_objects(const GltfDocument& document) {
  std::size_t count = 0;
  for (const char* key : {"textures", "cameras", "animations", "skins"}) {
    const auto found = document.json.find(key);
    if (found != document.json.end() && found->is_array()) count += found->size();
  }
  const GltfJson::json_pointer lights("/extensions/KHR_lights_punctual/lights");
  return count + (document.json.contains(lights) ? document.json[lights].size() : 0);
}

std::size_t count_described_materials(const GltfDocument& document) {
  const auto has_other_than = [](const GltfJson& object, std::initializer_list<std::string_view> keys) {
    const auto items = object.items();
    return std::any_of(items.begin(), items.end(),
                       [&](const auto& item) { return std::find(keys.begin(), keys.end(), item.key()) == keys.end(); });
  };
  const auto is_described = [&](const GltfJson& material) {
    if (!material.is_object()) return false;
    const auto base = material.find("pbrMetallicRoughness");
    return has_other_than(material, {"name", "pbrMetallicRoughness"}) ||
           (base != material.end() && base->is_object() &&
            has_other_than(*base, {"metallicFactor", "roughnessFactor"}));
  };
  const GltfJson& materials = items_of(document.json, "materials");
  return static_cast<std::size_t>(std::count_if(materials.begin(), materials.end(), is_described));
}

const SceneLayout* scene_layout(const MeshAttributes& attributes) { return attributes.document.get(); }

}  // namespace meshbound
