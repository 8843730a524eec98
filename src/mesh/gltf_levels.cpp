// SPDX-License-Identifier: MIT
// MSFT_lod: https://github.com/KhronosGroup/glTF/tree/main/extensions/2.0/Vendor/MSFT_lod
#include "mesh/gltf_levels.h"

#include <algorithm>
#include <charconv>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <system_error>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "mesh/gltf_attributes.h"
#include "mesh/gltf_buffer.h"
#include "mesh/gltf_references.h"

namespace meshbound {
namespace {

/// The properties of the vertices of a primitive by name, as `visit_properties` has them.
using Properties = std::map<std::string, const GltfAccessor*>;

/// Vertices with properties that are stored alike, each once.
class VertexTable {
 public:
  /// Adds vertices and returns their numbers in the table.
  std::vector<std::uint32_t> add(const Properties& properties) {
    std::vector<std::uint32_t> numbers;
    for (std::size_t v = 0; v < properties.begin()->second->count; ++v) {
      const std::size_t hash = hash_of(properties, v);
      const auto [begin, end] = numbers_of_.equal_range(hash);
      const auto found = std::find_if(begin, end, [&](const auto& at) { return is_stored(properties, v, at.second); });
      numbers.push_back(found != end ? found->second : static_cast<std::uint32_t>(size()));
      if (found != end) continue;
      append(properties, v);
      numbers_of_.emplace(hash, numbers.back());
    }
    return numbers;
  }

  [[nodiscard]] std::size_t size() const { return numbers_of_.size(); }

  void write(GltfBuffer& buffer) {
    for (const auto& [name, column] : columns_)
      accessor_of_[name] =
          buffer.add_accessor(column.numbers, column.values, name == "POSITION" || name.ends_with("/POSITION"));
  }

  /// Makes the vertices those of a primitive, after `write`.
  void show_in(GltfJson& primitive) const {
    for (auto& item : primitive["attributes"].items()) item.value() = accessor_of_.at(item.key());
    if (!primitive.contains("targets")) return;
    for (std::size_t k = 0; k < primitive["targets"].size(); ++k)
      for (auto& item : primitive["targets"][k].items()) item.value() = accessor_of_.at(target_name(k, item.key()));
  }

 private:
  static const double* element(const GltfAccessor& property, std::size_t vertex) {
    return property.values.data() + vertex * property.numbers.width;
  }

  /// The numbers of a vertex as bytes: two of them are alike where all bits are.
  static std::string_view bytes(const GltfAccessor& property, std::size_t vertex) {
    return {reinterpret_cast<const char*>(element(property, vertex)), property.numbers.width * sizeof(double)};
  }

  static std::size_t hash_of(const Properties& properties, std::size_t vertex) {
    std::size_t hash = 0;
    for (const auto& [name, property] : properties)
      hash = 31 * hash + std::hash<std::string_view>()(bytes(*property, vertex));
    return hash;
  }

  [[nodiscard]] bool is_stored(const Properties& properties, std::size_t vertex, std::size_t number) const {
    return std::all_of(properties.begin(), properties.end(), [&](const auto& named) {
      return bytes(*named.second, vertex) == bytes(columns_.at(named.first), number);
    });
  }

  void append(const Properties& properties, std::size_t vertex) {
    for (const auto& [name, property] : properties) {
      GltfAccessor& column = columns_[name];
      column.numbers = property->numbers;
      const double* const first = element(*property, vertex);
      column.values.insert(column.values.end(), first, first + property->numbers.width);
    }
  }

  std::map<std::string, GltfAccessor> columns_;                     ///< by name of the property
  std::map<std::string, std::size_t> accessor_of_;                  ///< by name of the property: its number in the file
  std::unordered_multimap<std::size_t, std::uint32_t> numbers_of_;  ///< by hash: vertices of the table
};

class LevelMerger {
 public:
  LevelMerger(const std::vector<GltfLevel>& levels, LevelVertices vertices)
      : levels_(levels), vertices_(vertices), json_(levels.front().document.json) {}

  /// Takes a mesh of a level, which stands for mesh `finest` of the finest level, and returns its number in the result.
  std::size_t mesh(std::size_t level, std::size_t number, std::size_t finest) {
    const GltfJson& mesh = levels_[level].document.json["meshes"][number];
    const std::size_t result = level == 0 ? number : json_["meshes"].size() + coarser_.size();
    if (level > 0) coarser_.push_back(mesh);
    for (std::size_t i = 0; i < mesh["primitives"].size(); ++i)
      take_primitive(levels_[level], mesh["primitives"][i], finest, {result, i});
    return result;
  }

  std::size_t add_node(GltfJson node) {
    json_["nodes"].push_back(std::move(node));
    return json_["nodes"].size() - 1;
  }

  GltfJson& json() { return json_; }

  GltfContent finish() {
    GltfJson& used = json_["extensionsUsed"];
    if (std::find(used.begin(), used.end(), "MSFT_lod") == used.end()) used.push_back("MSFT_lod");
    GltfBuffer buffer(json_, levels_.front().document.buffers);
    std::vector<const GltfJson*> replaced;
    for (const Primitive& p : primitives_)
      if (p.mesh < json_["meshes"].size()) replaced.push_back(&json_["meshes"][p.mesh]["primitives"][p.number]);
    buffer.free_accessors(accessors_used_only_by(replaced, json_));
    for (GltfJson& mesh : coarser_) json_["meshes"].push_back(std::move(mesh));
    for (auto& [key, table] : tables_) table.write(buffer);
    for (const Primitive& p : primitives_) {
      GltfJson& primitive = json_["meshes"][p.mesh]["primitives"][p.number];
      p.table->show_in(primitive);
      primitive["indices"] = buffer.add_indices(p.triangles, p.table->size());
    }
    std::string bytes = buffer.finish();
    return {std::move(json_), std::move(bytes)};
  }

 private:
  /// A primitive of the result, and its triangles by vertices of a table.
  struct Primitive {
    std::size_t mesh = 0, number = 0;
    VertexTable* table = nullptr;
    std::vector<Triangle> triangles = {};
  };

  /// Lines and points are those of the original in every level, and so are their accessors.
  void take_primitive(const GltfLevel& level, const GltfJson& primitive, std::size_t finest, Primitive to) {
    if (primitive.value("mode", GltfMode::triangles) != GltfMode::triangles) return;
    AccessorCache accessors(level.source, level.document);
    Properties properties;
    std::string layout;
    visit_properties(primitive, [&](const std::string& name, const GltfJson& number) {
      const GltfAccessor& property = *(properties[name] = &accessors.at(number.get<std::size_t>()));
      layout += name + ' ' + std::to_string(static_cast<int>(property.numbers.component)) +
                std::to_string(property.numbers.width) + (property.numbers.normalized ? "n " : " ");
    });
    if (properties.empty()) return;
    const std::size_t count = properties.begin()->second->count;
    for (const auto& [name, property] : properties)
      if (property->count != count) level.source.fail("the properties of a primitive have different counts");
    const bool is_shared = vertices_ == LevelVertices::Shared;
    to.table = &tables_[{finest, layout, is_shared ? 0 : to.mesh, is_shared ? 0 : to.number}];
    const std::vector<std::uint32_t> numbers = to.table->add(properties);
    std::vector<std::uint32_t> corners = numbers;
    if (const auto indices = number_in(primitive, "indices")) {
      corners.clear();
      for (const double vertex : accessors.at(*indices).values) {
        if (!(vertex < static_cast<double>(count))) level.source.fail("a primitive lacks a vertex that it refers to");
        corners.push_back(numbers[static_cast<std::size_t>(vertex)]);
      }
    }
    for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
      to.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
    primitives_.push_back(std::move(to));
  }

  /// By mesh of the finest level and layout; where levels do not share them, also by mesh and primitive of the result.
  using TableKey = std::tuple<std::size_t, std::string, std::size_t, std::size_t>;

  const std::vector<GltfLevel>& levels_;
  LevelVertices vertices_;
  GltfJson json_;
  std::vector<GltfJson> coarser_;  ///< meshes of coarser levels, which follow those of the finest
  std::map<TableKey, VertexTable> tables_;
  std::vector<Primitive> primitives_;
};

/// Redirects animations of the node's morph weights to node `mesh_is_at`, if given. Returns whether the node is
/// animated.
bool retarget(GltfJson& json, std::size_t node, std::optional<std::size_t> mesh_is_at) {
  bool is_animated = false;
  if (!json.contains("animations")) return false;
  for (GltfJson& animation : json["animations"]) {
    for (GltfJson& channel : animation["channels"]) {
      GltfJson& target = channel["target"];
      if (target.value("node", node + 1) != node) continue;
      is_animated = true;
      if (mesh_is_at && target.value("path", "") == "weights") target["node"] = *mesh_is_at;
    }
  }
  return is_animated;
}

/// The nodes to which texts of the document point, as those of KHR_animation_pointer do ("/nodes/1/translation").
struct PointedNodes {
  std::set<std::size_t> numbers;
  bool may_be_any = false;  ///< a number is computed, as KHR_interactivity allows ("/nodes/{node}/translation")

  [[nodiscard]] bool contains(std::size_t node) const { return may_be_any || numbers.contains(node); }
};

constexpr std::string_view pointer_to_node = "/nodes/";

/// The number of the node to which a text points.
std::optional<std::size_t> pointed_node(std::string_view text) {
  if (!text.starts_with(pointer_to_node)) return std::nullopt;
  const char* const end = text.data() + text.size();
  std::size_t number = 0;
  const auto parsed = std::from_chars(text.data() + pointer_to_node.size(), end, number);
  if (parsed.ec != std::errc() || (parsed.ptr != end && *parsed.ptr != '/')) return std::nullopt;
  return number;
}

/// Calls visit(text) for each text in a value.
template <class Visit>
void visit_texts(GltfJson& value, const Visit& visit) {
  if (value.is_string()) visit(value);
  if (value.is_structured())
    for (GltfJson& item : value) visit_texts(item, visit);
}

PointedNodes pointed_nodes(GltfJson& json) {
  PointedNodes result;
  visit_texts(json, [&](const GltfJson& value) {
    const auto& text = value.get_ref<const std::string&>();
    if (const auto node = pointed_node(text)) result.numbers.insert(*node);
    if (text.starts_with("/nodes/{")) result.may_be_any = true;
  });
  return result;
}

/// Redirects texts that point to the morph weights of a node to another one.
void redirect_weights(GltfJson& json, std::size_t node, std::size_t to) {
  const std::string weights = std::string(pointer_to_node) + std::to_string(node) + "/weights";
  visit_texts(json, [&](GltfJson& value) {
    const auto& text = value.get_ref<const std::string&>();
    if (text == weights || text.starts_with(weights + '/'))
      value = std::string(pointer_to_node) + std::to_string(to) + "/weights" + text.substr(weights.size());
  });
}

/// Whether levels must not take the place of the node itself, as they would lack what else the node is: children, a
/// camera, extensions such as lights or further levels, or the aim of an animation, which must apply to every level.
bool is_more_than_a_mesh(GltfJson& json, std::size_t number, const PointedNodes& pointed) {
  const GltfJson& node = json["nodes"][number];
  return node.contains("children") || node.contains("camera") || node.contains("extensions") ||
         (node.contains("extras") && !node["extras"].is_object()) || retarget(json, number, std::nullopt) ||
         pointed.contains(number);
}

/// The node that gets the levels: the node itself or, where it is more than a mesh, a new child that shows its mesh.
std::size_t node_of_levels(LevelMerger& merger, std::size_t node, const PointedNodes& pointed) {
  GltfJson& json = merger.json();
  if (!is_more_than_a_mesh(json, node, pointed)) return node;
  GltfJson child = GltfJson::object();
  for (const char* const key : {"mesh", "skin", "weights"}) {
    if (!json["nodes"][node].contains(key)) continue;
    child[key] = json["nodes"][node][key];
    json["nodes"][node].erase(key);
  }
  const std::size_t added = merger.add_node(std::move(child));
  json["nodes"][node]["children"].push_back(added);
  retarget(json, node, added);
  if (pointed.numbers.contains(node)) redirect_weights(json, node, added);
  return added;
}

/// As `with_levels`; throws what the library of JSON throws where a document is malformed.
GltfContent merged(const std::vector<GltfLevel>& levels, const std::vector<NodeCoverage>& nodes,
                   LevelVertices vertices) {
  LevelMerger merger(levels, vertices);
  // By level and mesh of that level: mesh of the result.
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> mesh_of;
  const auto mesh_at = [&](std::size_t level, std::size_t number, std::size_t finest) {
    const auto [at, is_new] = mesh_of.try_emplace({level, number}, 0);
    if (is_new) at->second = merger.mesh(level, number, finest);
    return at->second;
  };
  const PointedNodes pointed = pointed_nodes(merger.json());
  for (const NodeCoverage& covered : nodes) {
    const auto finest = number_in(levels.front().document.json["nodes"][covered.node], "mesh");
    if (!finest) continue;
    mesh_at(0, *finest, *finest);
    const std::size_t node = node_of_levels(merger, covered.node, pointed);
    GltfJson ids = GltfJson::array();
    for (std::size_t level = 1; level < levels.size(); ++level) {
      GltfJson coarser = merger.json()["nodes"][node];
      for (const char* const key : {"mesh", "extensions", "extras", "name"}) coarser.erase(key);
      if (const auto mesh = number_in(levels[level].document.json["nodes"][covered.node], "mesh")) {
        coarser["mesh"] = mesh_at(level, *mesh, *finest);
      } else {
        for (const char* const key : {"skin", "weights"}) coarser.erase(key);
      }
      ids.push_back(merger.add_node(std::move(coarser)));
    }
    GltfJson& shown = merger.json()["nodes"][node];
    shown["extensions"]["MSFT_lod"] = {{"ids", std::move(ids)}};
    shown["extras"]["MSFT_screencoverage"] = covered.shares;
  }
  return merger.finish();
}

}  // namespace

GltfContent with_levels(const std::vector<GltfLevel>& levels, const std::vector<NodeCoverage>& nodes,
                        LevelVertices vertices) {
  try {
    return merged(levels, nodes, vertices);
  } catch (const GltfJson::exception& error) {
    throw malformed_origin(error);
  }
}

}  // namespace meshbound
