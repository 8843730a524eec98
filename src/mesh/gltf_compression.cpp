// SPDX-License-Identifier: MIT
// Khronos: the specifications of EXT_meshopt_compression and KHR_draco_mesh_compression.
#include "mesh/gltf_compression.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mesh/draco_decoder.h"
#include "mesh/gltf_buffer.h"
#include "mesh/meshopt_decoder.h"

namespace meshbound {
namespace {

constexpr const char* meshopt = "EXT_meshopt_compression";
constexpr const char* newer_meshopt = "KHR_meshopt_compression";
constexpr const char* draco = "KHR_draco_mesh_compression";
constexpr std::array<const char*, 3> compressions = {meshopt, newer_meshopt, draco};

std::optional<GltfValue> find_extension(const GltfValue& of, const char* name) {
  const auto extensions = of.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

void remove_extension(GltfJson& from, const char* name) {
  const auto extensions = from.is_object() ? from.find("extensions") : from.end();
  if (!from.is_object() || extensions == from.end() || !extensions->is_object()) return;
  extensions->erase(name);
  if (extensions->empty()) from.erase("extensions");
}

/// The elements of a compressed buffer view, decoded and filtered.
class CompressedView {
 public:
  CompressedView(const GltfValue& view, const GltfValue& extension, const std::vector<std::string>& buffers)
      : extension_(extension),
        stride_(extension.at("byteStride").integer()),
        count_(extension.at("count").integer()),
        mode_(extension.at("mode").text()) {
    if (const auto filter = extension.find("filter")) filter_ = filter->text();
    check_layout(view);
    stream_ = bytes_of(extension, buffers);
  }

  [[nodiscard]] std::string decode() const {
    auto elements = decoded_stream();
    if (!elements)
      extension_.fail("the compressed data are malformed, or not of " + std::to_string(count_) + " elements of " +
                      std::to_string(stride_) + " bytes");
    if (filter_ == "OCTAHEDRAL") apply_octahedral_filter(*elements, stride_);
    if (filter_ == "QUATERNION") apply_quaternion_filter(*elements);
    if (filter_ == "EXPONENTIAL") apply_exponential_filter(*elements);
    return *std::move(elements);
  }

 private:
  static constexpr std::size_t max_stride = 256;  // bytes, as specified

  void check_layout(const GltfValue& view) const {
    const bool is_attributes = mode_ == "ATTRIBUTES", is_triangles = mode_ == "TRIANGLES";
    if (!is_attributes && !is_triangles && mode_ != "INDICES")
      extension_.fail("the mode " + quote(mode_) + " is not known");
    const bool stride_fits =
        is_attributes ? stride_ >= 4 && stride_ <= max_stride && stride_ % 4 == 0 : stride_ == 2 || stride_ == 4;
    if (!stride_fits || !filter_fits(is_attributes))
      extension_.fail("elements of " + std::to_string(stride_) + " bytes have no mode " + quote(mode_) +
                      " with the filter " + quote(filter_));
    if (is_triangles && count_ % 3 != 0) extension_.fail("the number of indices is no multiple of 3");
    if (count_ > std::numeric_limits<std::uint32_t>::max() || view.at("byteLength").integer() != count_ * stride_)
      extension_.fail("the buffer view has another length than " + std::to_string(count_) + " elements of " +
                      std::to_string(stride_) + " bytes");
  }

  [[nodiscard]] bool filter_fits(bool is_attributes) const {
    if (filter_ == "NONE") return true;
    if (!is_attributes) return false;
    if (filter_ == "OCTAHEDRAL") return stride_ == 4 || stride_ == 8;
    return filter_ == "QUATERNION" ? stride_ == 8 : filter_ == "EXPONENTIAL";
  }

  [[nodiscard]] std::optional<std::string> decoded_stream() const {
    if (mode_ == "ATTRIBUTES") return decode_meshopt_attributes(stream_, count_, stride_);
    if (mode_ == "TRIANGLES") return decode_meshopt_triangles(stream_, count_, stride_);
    return decode_meshopt_indices(stream_, count_, stride_);
  }

  const GltfValue& extension_;
  std::size_t stride_, count_;
  std::string mode_, filter_ = "NONE";
  std::string_view stream_;
};

class Decompression {
 public:
  Decompression(const MeshSource& source, GltfDocument& document)
      : source_(source), document_(document), json_(document.json), root_(source, document.json) {}

  void run() {
    for (std::size_t i = 0; i < root_.count("bufferViews"); ++i) decode_view(i);
    for (std::size_t i = 0; i < root_.count("buffers"); ++i)
      for (const char* const name : {meshopt, newer_meshopt}) remove_extension(json_["buffers"][i], name);
    for (std::size_t mesh = 0; mesh < root_.count("meshes"); ++mesh) {
      const GltfValue at = root_.at("meshes").item(mesh);
      for (std::size_t i = 0; i < at.count("primitives"); ++i)
        decode_primitive(json_["meshes"][mesh]["primitives"][i], at.at("primitives").item(i));
    }
    for (const auto& [view, mesh] : meshes_) json_["bufferViews"][view]["byteLength"] = std::size_t{1};
    for (const char* const list : {"extensionsUsed", "extensionsRequired"}) remove_names(list);
  }

 private:
  static constexpr std::int64_t indices_identifier = -1;

  /// What an accessor holds: the attribute with this identifier, or the indices, of the mesh compressed in a view.
  struct Origin {
    std::size_t view;
    std::int64_t identifier;
    bool operator==(const Origin&) const = default;
  };

  std::size_t add_buffer(std::string bytes) {
    document_.buffers.push_back(std::move(bytes));
    return document_.buffers.size() - 1;
  }

  void decode_view(std::size_t number) {
    source_.end_if_stopped();
    const GltfValue view = root_.at("bufferViews").item(number);
    GltfJson& json = json_["bufferViews"][number];
    if (const auto extension = find_extension(view, meshopt)) {
      std::string bytes = CompressedView(view, *extension, document_.buffers).decode();
      remove_extension(json, meshopt);
      json["buffer"] = add_buffer(std::move(bytes));
      json["byteOffset"] = 0;
    }
    remove_extension(json, newer_meshopt);
  }

  void decode_primitive(GltfJson& json, const GltfValue& primitive) {
    source_.end_if_stopped();
    if (const auto extension = find_extension(primitive, draco)) {
      if (!has_uncompressed_data(primitive, *extension)) use_compressed_data(json, primitive, *extension);
      remove_extension(json, draco);
    }
  }

  /// Whether the file itself holds data for an accessor, not only a compressed mesh that was decoded before.
  [[nodiscard]] bool has_data(const GltfValue& accessor) const {
    const std::size_t number = accessor.index(root_.count("accessors"), "accessors");
    const GltfValue declared = root_.at("accessors").item(number);
    return !origin_of_.contains(number) && (declared.find("bufferView") || declared.find("sparse"));
  }

  [[nodiscard]] bool has_uncompressed_data(const GltfValue& primitive, const GltfValue& extension) const {
    const GltfValue attributes = primitive.at("attributes");
    for (const auto& [semantic, unused] : extension.at("attributes").json().items())
      if (!has_data(attributes.at(semantic.c_str()))) return false;
    const auto indices = primitive.find("indices");
    return indices && has_data(*indices);
  }

  void use_compressed_data(GltfJson& json, const GltfValue& primitive, const GltfValue& extension) {
    const std::size_t mode = primitive.integer_or("mode", GltfMode::triangles);
    if (mode != GltfMode::triangles && mode != GltfMode::strip)
      extension.fail("only triangles and strips of triangles can be compressed");
    const std::size_t view = extension.at("bufferView").index(root_.count("bufferViews"), "buffer views");
    const DracoMesh& mesh = decoded_mesh(view, extension);
    const GltfValue attributes = primitive.at("attributes");
    for (const auto& [semantic, unused] : extension.at("attributes").json().items()) {
      const GltfValue accessor = attributes.at(semantic.c_str());
      const GltfValue identifier = extension.at("attributes").at(semantic.c_str());
      const auto number =
          static_cast<std::uint32_t>(identifier.index(std::numeric_limits<std::int32_t>::max(), "attributes"));
      json["attributes"][semantic] = filled(accessor, {view, number}, mesh.vertex_count(), [&](std::size_t width) {
        auto values = mesh.values(number, width);
        if (!values)
          identifier.fail("the compressed mesh has no such attribute of " + std::to_string(width) + " numbers");
        return *std::move(values);
      });
    }
    use_compressed_indices(json, primitive, mesh, {view, indices_identifier}, mode);
  }

  /// Last, since a new key moves the others of the primitive in memory.
  void use_compressed_indices(GltfJson& json, const GltfValue& primitive, const DracoMesh& mesh, const Origin& origin,
                              std::size_t mode) {
    const std::size_t count = 3 * mesh.triangle_count();
    if (mode == GltfMode::strip || !primitive.find("indices")) {
      json_["accessors"].push_back(
          {{"componentType", static_cast<int>(GltfComponent::UInt32)}, {"count", count}, {"type", "SCALAR"}});
      json["indices"] = json_["accessors"].size() - 1;
    }
    json["indices"] = filled(primitive.at("indices"), origin, count, [&](std::size_t) { return mesh.indices(); });
    json.erase("mode");
  }

  const DracoMesh& decoded_mesh(std::size_t view, const GltfValue& extension) {
    const auto found = meshes_.find(view);
    if (found != meshes_.end()) return found->second;
    if (!can_decode_draco())
      extension.fail("this build does not read data compressed by Draco; convert the file to one without it");
    const GltfValue at = root_.at("bufferViews").item(view);
    const std::string_view bytes = bytes_of(at, document_.buffers);
    if (bytes.empty()) at.fail("is empty");
    auto mesh = DracoMesh::decode(bytes);
    if (!mesh) extension.fail("the compressed mesh is malformed");
    return meshes_.emplace(view, *std::move(mesh)).first->second;
  }

  /// Puts `count` elements into the accessor that `reference` names and returns its number; that of a copy where it
  /// holds data of another compressed mesh already. `values_of(width)` returns `width` numbers for each element.
  template <class Values>
  std::size_t filled(const GltfValue& reference, const Origin& origin, std::size_t count, const Values& values_of) {
    const std::size_t number = reference.index(root_.count("accessors"), "accessors");
    const auto [known, is_first] = origin_of_.try_emplace(number, origin);
    if (!is_first && known->second == origin) return number;
    const GltfValue declared = root_.at("accessors").item(number);
    if (declared.at("count").integer() != count)
      declared.fail("declares " + std::to_string(declared.at("count").integer()) + " elements, but " +
                    std::to_string(count) + " are compressed");
    const GltfNumbers numbers = numbers_of(declared);
    const bool is_indices = origin.identifier == indices_identifier;
    const std::size_t size = size_of(numbers.component) * numbers.width;
    const std::size_t stride = is_indices ? size : padded_to_alignment(size);
    // What is compressed are the integers themselves, also where they stand for numbers from 0 to 1.
    const GltfNumbers as_stored{numbers.component, false, numbers.width};
    GltfJson accessor = declared.json();
    for (const char* const key : {"byteOffset", "sparse"}) accessor.erase(key);
    const std::vector<double> values = values_of(numbers.width);
    accessor["bufferView"] = add_view(packed_elements(as_stored, values, stride), stride != size ? stride : 0);
    if (accessor.contains("min") && accessor.contains("max")) set_range(accessor, values, numbers.width);
    GltfJson& accessors = json_["accessors"];
    if (is_first) {
      accessors[number] = std::move(accessor);
      return number;
    }
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  /// Compression moves numbers a little, so that the smallest and largest may be others than declared.
  static void set_range(GltfJson& accessor, const std::vector<double>& values, std::size_t width) {
    accessor["min"] = accessor["max"] = GltfJson::array();
    for (std::size_t k = 0; k < std::min(width, values.size()); ++k) {
      double min = values[k], max = min;
      for (std::size_t i = k; i < values.size(); i += width) {
        min = std::min(min, values[i]);
        max = std::max(max, values[i]);
      }
      accessor["min"].push_back(min);
      accessor["max"].push_back(max);
    }
  }

  std::size_t add_view(std::string bytes, std::size_t stride) {
    GltfJson view = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", bytes.size()}};
    view["buffer"] = add_buffer(std::move(bytes));
    if (stride != 0) view["byteStride"] = stride;
    json_["bufferViews"].push_back(std::move(view));
    return json_["bufferViews"].size() - 1;
  }

  void remove_names(const char* list) {
    const auto names = json_.find(list);
    if (names == json_.end() || !names->is_array()) return;
    GltfJson kept = GltfJson::array();
    for (const GltfJson& name : *names)
      if (std::find(compressions.begin(), compressions.end(), name) == compressions.end()) kept.push_back(name);
    if (kept.empty())
      json_.erase(list);
    else
      *names = std::move(kept);
  }

  const MeshSource& source_;
  GltfDocument& document_;
  GltfJson& json_;
  GltfValue root_;
  std::map<std::size_t, DracoMesh> meshes_;  ///< by buffer view
  std::map<std::size_t, Origin> origin_of_;  ///< by accessor
};

bool uses_extension(const GltfValue& root, const char* name) {
  const auto used = root.find("extensionsUsed");
  return used && used->json().is_array() &&
         std::find(used->json().begin(), used->json().end(), name) != used->json().end();
}

}  // namespace

bool is_read_compression(std::string_view extension) {
  return extension == meshopt || (extension == draco && can_decode_draco());
}

bool is_placeholder_buffer(const GltfValue& root, const GltfValue& buffer) {
  if (const auto extension = find_extension(buffer, meshopt)) return extension->flag_or("fallback", false);
  return !buffer.find("uri") && uses_extension(root, meshopt);
}

void decompress(const MeshSource& source, GltfDocument& document) { Decompression(source, document).run(); }

}  // namespace meshbound
