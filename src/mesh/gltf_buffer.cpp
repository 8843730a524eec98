// SPDX-License-Identifier: MIT
#include "mesh/gltf_buffer.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <utility>

#include "meshbound/error.h"
#include "numeric/byte_order.h"
#include "numeric/rounded_to_float.h"

namespace meshbound {
namespace {

constexpr std::size_t alignment = 4;  // bytes: of every buffer view and of the elements of vertices
constexpr int target_vertices = 34962, target_indices = 34963;
constexpr std::array<const char*, 2> added_to = {"accessors", "bufferViews"};

const char* type_of_width(std::size_t width) { return gltf_types[std::min(width, gltf_types.size()) - 1]; }

template <class T>
void append(std::string& to, T value) {
  std::array<char, sizeof(T)> bytes;
  store_number(value, bytes.data(), std::endian::little);
  to.append(bytes.data(), bytes.size());
}

template <class T>
void append_integer(std::string& to, double value, bool normalized) {
  constexpr double max = std::numeric_limits<T>::max(), min = std::numeric_limits<T>::min();
  const double scaled = std::round(normalized ? value * max : value);
  append(to, static_cast<T>(std::clamp(std::isnan(scaled) ? 0.0 : scaled, min, max)));
}

void append_number(std::string& to, const GltfNumbers& numbers, double value) {
  switch (numbers.component) {
    case GltfComponent::Int8:
      return append_integer<std::int8_t>(to, value, numbers.normalized);
    case GltfComponent::UInt8:
      return append_integer<std::uint8_t>(to, value, numbers.normalized);
    case GltfComponent::Int16:
      return append_integer<std::int16_t>(to, value, numbers.normalized);
    case GltfComponent::UInt16:
      return append_integer<std::uint16_t>(to, value, numbers.normalized);
    case GltfComponent::UInt32:
      return append_integer<std::uint32_t>(to, value, false);
    case GltfComponent::Float:
      break;
  }
  append(to, static_cast<float>(rounded_to_float(value)));
}

/// Visits the number behind every key "bufferView", wherever it stands.
void visit_views(const GltfJson& json, const std::function<void(std::size_t)>& visit) {
  if (!json.is_structured()) return;
  for (auto item = json.begin(); item != json.end(); ++item) {
    if (json.is_object() && item.key() == "bufferView" && item->is_number_unsigned())
      visit(item->get<std::size_t>());
    else
      visit_views(*item, visit);
  }
}

std::size_t integer_or(const GltfJson& object, const char* key, std::size_t otherwise) {
  const auto found = object.find(key);
  return found != object.end() && found->is_number_unsigned() ? found->get<std::size_t>() : otherwise;
}

/// A valid and small accessor that takes the number of a freed one which no new accessor has taken.
const GltfJson& unused_accessor() {
  static const GltfJson accessor = {{"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}};
  return accessor;
}

}  // namespace

std::size_t padded_to_alignment(std::size_t size) { return (size + alignment - 1) / alignment * alignment; }

std::string packed_elements(const GltfNumbers& numbers, const std::vector<double>& values, std::size_t stride) {
  const std::size_t size = size_of(numbers.component) * numbers.width;
  std::string bytes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    append_number(bytes, numbers, values[i]);
    if ((i + 1) % numbers.width == 0) bytes.resize(bytes.size() + stride - size);
  }
  return bytes;
}

/// Makes every array that entries are added to before anything else: adding a key to an ordered object moves all other
/// keys in memory, and callers hold references into the document.
GltfBuffer::GltfBuffer(GltfJson& json, const std::vector<std::string>& buffers) : json_(json), old_(buffers) {
  for (const char* const key : added_to)
    if (!json_.contains(key)) json_[key] = GltfJson::array();
}

void GltfBuffer::free_accessors(const std::vector<std::size_t>& accessors) {
  std::set<std::size_t> views;
  for (const std::size_t i : accessors) {
    GltfJson& accessor = json_["accessors"][i];
    visit_views(accessor, [&](std::size_t view) { views.insert(view); });
    accessor = unused_accessor();
  }
  visit_views(json_, [&](std::size_t view) { views.erase(view); });
  free_accessors_ = accessors;
  std::sort(free_accessors_.rbegin(), free_accessors_.rend());
  for (const std::size_t view : views)
    if (view < json_["bufferViews"].size()) free_views_.insert(free_views_.begin(), view);
}

std::size_t GltfBuffer::add_item(const char* key, GltfJson item, std::vector<std::size_t>& free) {
  GltfJson& items = json_[key];
  if (free.empty()) {
    items.push_back(std::move(item));
    return items.size() - 1;
  }
  const std::size_t number = free.back();
  free.pop_back();
  items[number] = std::move(item);
  return number;
}

std::size_t GltfBuffer::add_view(std::string_view bytes, std::size_t stride, int target) {
  bytes_.resize(padded_to_alignment(bytes_.size()));
  GltfJson view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  if (target != 0) view["target"] = target;
  bytes_ += bytes;
  const std::size_t number = add_item("bufferViews", std::move(view), free_views_);
  new_views_.push_back(number);
  return number;
}

std::size_t GltfBuffer::add_accessor(const GltfNumbers& numbers, const std::vector<double>& values, bool with_range) {
  const std::size_t size = size_of(numbers.component) * numbers.width, count = values.size() / numbers.width;
  const std::size_t stride = padded_to_alignment(size);
  GltfJson accessor = {
      {"bufferView", add_view(packed_elements(numbers, values, stride), stride != size ? stride : 0, target_vertices)},
      {"componentType", static_cast<int>(numbers.component)},
      {"count", count},
      {"type", type_of_width(numbers.width)}};
  if (numbers.normalized) accessor["normalized"] = true;
  for (std::size_t k = 0; with_range && count > 0 && k < numbers.width; ++k) {
    double min = rounded_to_float(values[k]), max = min;
    for (std::size_t i = k; i < values.size(); i += numbers.width) {
      min = std::min(min, rounded_to_float(values[i]));
      max = std::max(max, rounded_to_float(values[i]));
    }
    accessor["min"].push_back(min);
    accessor["max"].push_back(max);
  }
  return add_item("accessors", std::move(accessor), free_accessors_);
}

std::size_t GltfBuffer::add_indices(const std::vector<Triangle>& triangles, std::size_t vertices) {
  // glTF reserves the largest value of an index type for primitive restart.
  const bool is_short = vertices < std::numeric_limits<std::uint16_t>::max();
  const GltfNumbers numbers{is_short ? GltfComponent::UInt16 : GltfComponent::UInt32, false, 1};
  std::string bytes;
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) append_number(bytes, numbers, v);
  GltfJson accessor = {{"bufferView", add_view(bytes, 0, target_indices)},
                       {"componentType", static_cast<int>(numbers.component)},
                       {"count", 3 * triangles.size()},
                       {"type", "SCALAR"}};
  return add_item("accessors", std::move(accessor), free_accessors_);
}

void GltfBuffer::move_old_view(GltfJson& view, std::size_t number) {
  const auto fail = [&](const std::string& defect) {
    throw InvalidInput("bufferViews[" + std::to_string(number) + "] of the glTF file: " + defect);
  };
  if (!view.is_object()) fail("expected an object of JSON");
  const std::size_t buffer = integer_or(view, "buffer", old_.size());
  const std::size_t offset = integer_or(view, "byteOffset", 0), length = integer_or(view, "byteLength", 0);
  if (buffer >= old_.size() || offset > old_[buffer].size() || length > old_[buffer].size() - offset)
    fail("reaches beyond its buffer");
  bytes_.resize(padded_to_alignment(bytes_.size()));
  view["buffer"] = 0;
  view["byteOffset"] = bytes_.size();
  bytes_ += std::string_view(old_[buffer]).substr(offset, length);
}

/// Removes freed entries at the end of the arrays and fills the others with small valid ones, since numbers may not
/// shift.
void GltfBuffer::fill_free_places() {
  const auto drop_last = [&](const char* key, std::vector<std::size_t>& free) {
    std::sort(free.begin(), free.end());
    while (!free.empty() && free.back() + 1 == json_[key].size()) {
      json_[key].erase(free.back());
      free.pop_back();
    }
  };
  drop_last("accessors", free_accessors_);
  drop_last("bufferViews", free_views_);
  for (const std::size_t view : free_views_) {
    json_["bufferViews"][view] = {{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 1}};
    new_views_.push_back(view);
  }
}

std::string GltfBuffer::finish() {
  fill_free_places();
  std::sort(new_views_.begin(), new_views_.end());
  GltfJson& views = json_["bufferViews"];
  for (std::size_t i = 0; i < views.size(); ++i)
    if (!std::binary_search(new_views_.begin(), new_views_.end(), i)) move_old_view(views[i], i);
  for (const char* const key : added_to)
    if (json_[key].empty()) json_.erase(key);
  if (bytes_.empty()) {
    json_.erase("buffers");
    return {};
  }
  bytes_.resize(padded_to_alignment(bytes_.size()));
  GltfJson& buffers = json_["buffers"];
  GltfJson buffer = buffers.is_array() && !buffers.empty() && buffers[0].is_object() ? buffers[0] : GltfJson::object();
  buffer.erase("uri");
  buffer["byteLength"] = bytes_.size();
  buffers = GltfJson::array({std::move(buffer)});
  return std::move(bytes_);
}

}  // namespace meshbound
