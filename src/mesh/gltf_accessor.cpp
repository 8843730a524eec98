// SPDX-License-Identifier: MIT
// Accessors of glTF 2.0 ("glTF 2.0 Specification", 3.6.2).
#include <algorithm>
#include <array>
#include <bit>
#include <string>

#include "mesh/gltf_document.h"
#include "numeric/byte_order.h"

namespace meshbound {
namespace {

struct Elements {
  std::string_view bytes;  ///< from the first one on
  std::size_t stride = 0;
};

GltfComponent component_of(const GltfValue& accessor) {
  const GltfValue type = accessor.at("componentType");
  const std::size_t number = type.integer();
  if (number < 5120 || number > 5126 || number == 5124) type.fail("is none of the types of glTF 2");
  return static_cast<GltfComponent>(number);
}

std::size_t width_of(const GltfValue& accessor) {
  const std::string type = accessor.at("type").text();
  const auto found = std::find(gltf_types.begin(), gltf_types.end(), type);
  if (found == gltf_types.end()) accessor.fail("elements of type " + quote(type) + " are not read");
  return static_cast<std::size_t>(found - gltf_types.begin()) + 1;
}

class AccessorReader {
 public:
  AccessorReader(const MeshSource& source, const GltfDocument& document)
      : source_(source), document_(document), root_(source, document.json) {}

  GltfAccessor read(std::size_t index) {
    const GltfValue accessor = root_.at("accessors").item(index);
    GltfAccessor result;
    result.numbers = numbers_of(accessor);
    result.count = accessor.at("count").integer();
    const std::size_t size = size_of(result.numbers.component) * result.numbers.width;
    if (accessor.find("bufferView")) {
      const Elements from = elements(accessor, result.count, size);
      result.values.resize(result.count * result.numbers.width);
      for (std::size_t i = 0; i < result.count; ++i) load(from, i, result.numbers, element(result, i));
    } else {
      if (result.count > bytes_of_file())
        accessor.fail("declares " + std::to_string(result.count) + " elements without any data");
      result.values.resize(result.count * result.numbers.width);
    }
    if (const auto sparse = accessor.find("sparse")) put_sparse(*sparse, result);
    return result;
  }

 private:
  /// Bytes that justify elements without any of their own: those of the file and of all files that belong to it.
  [[nodiscard]] std::size_t bytes_of_file() const {
    std::size_t bytes = source_.bytes.size();
    for (const std::string& buffer : document_.buffers) bytes += buffer.size();
    return bytes;
  }

  static double* element(GltfAccessor& accessor, std::size_t i) {
    return accessor.values.data() + i * accessor.numbers.width;
  }

  /// The elements that the "bufferView" and "byteOffset" of `of` locate: `count` elements of `size` bytes each.
  [[nodiscard]] Elements elements(const GltfValue& of, std::size_t count, std::size_t size) const {
    const std::size_t number = of.at("bufferView").index(root_.count("bufferViews"), "buffer views");
    const GltfValue view = root_.at("bufferViews").item(number);
    const std::string_view bytes = bytes_of(view, document_.buffers);
    const std::size_t length = bytes.size();
    const std::size_t offset = of.integer_or("byteOffset", 0), stride = view.integer_or("byteStride", size);
    if (stride < size) view.fail("a stride of " + std::to_string(stride) + " bytes is too short for an element");
    if (count > 0 && (offset > length || size > length - offset || (count - 1) > (length - offset - size) / stride))
      of.fail("its " + std::to_string(count) + " elements reach beyond the " + std::to_string(length) +
              " bytes of their buffer view");
    return {bytes.substr(std::min(offset, length)), stride};
  }

  static void load(const Elements& from, std::size_t i, const GltfNumbers& numbers, double* to) {
    const char* at = from.bytes.data() + i * from.stride;
    for (std::size_t k = 0; k < numbers.width; ++k, at += size_of(numbers.component)) to[k] = number_at(at, numbers);
  }

  template <class T>
  static double as_number(const char* at, bool normalized) {
    const auto value = static_cast<double>(load_number<T>(at, std::endian::little));
    if (!normalized || std::is_floating_point_v<T>) return value;
    return std::max(value / static_cast<double>(std::numeric_limits<T>::max()), -1.0);
  }

  static double number_at(const char* at, const GltfNumbers& numbers) {
    switch (numbers.component) {
      case GltfComponent::Int8:
        return as_number<std::int8_t>(at, numbers.normalized);
      case GltfComponent::UInt8:
        return as_number<std::uint8_t>(at, numbers.normalized);
      case GltfComponent::Int16:
        return as_number<std::int16_t>(at, numbers.normalized);
      case GltfComponent::UInt16:
        return as_number<std::uint16_t>(at, numbers.normalized);
      case GltfComponent::UInt32:
        return as_number<std::uint32_t>(at, numbers.normalized);
      case GltfComponent::Float:
        break;
    }
    return as_number<float>(at, false);
  }

  void put_sparse(const GltfValue& sparse, GltfAccessor& accessor) const {
    const std::size_t count = sparse.at("count").integer();
    const GltfValue where = sparse.at("indices");
    const GltfNumbers integers{component_of(where), false, 1};
    const std::size_t size = size_of(accessor.numbers.component) * accessor.numbers.width;
    const Elements indices = elements(where, count, size_of(integers.component));
    const Elements values = elements(sparse.at("values"), count, size);
    for (std::size_t i = 0; i < count; ++i) {
      double index = 0;
      load(indices, i, integers, &index);
      if (!(index >= 0 && index < static_cast<double>(accessor.count)))
        where.fail("refers to an element that the accessor does not have");
      load(values, i, accessor.numbers, element(accessor, static_cast<std::size_t>(index)));
    }
  }

  const MeshSource& source_;
  const GltfDocument& document_;
  GltfValue root_;
};

}  // namespace

std::string_view bytes_of(const GltfValue& located, const std::vector<std::string>& buffers) {
  const std::string& buffer = buffers[located.at("buffer").index(buffers.size(), "buffers")];
  const std::size_t begin = located.integer_or("byteOffset", 0), length = located.at("byteLength").integer();
  if (begin > buffer.size() || length > buffer.size() - begin)
    located.fail("reaches beyond the " + std::to_string(buffer.size()) + " bytes of its buffer");
  return std::string_view(buffer).substr(begin, length);
}

GltfNumbers numbers_of(const GltfValue& accessor) {
  return {component_of(accessor), accessor.flag_or("normalized", false), width_of(accessor)};
}

std::size_t size_of(GltfComponent component) {
  switch (component) {
    case GltfComponent::Int8:
    case GltfComponent::UInt8:
      return 1;
    case GltfComponent::Int16:
    case GltfComponent::UInt16:
      return 2;
    case GltfComponent::UInt32:
    case GltfComponent::Float:
      break;
  }
  return 4;
}

GltfAccessor read_accessor(const MeshSource& source, const GltfDocument& document, std::size_t index) {
  return AccessorReader(source, document).read(index);
}

}  // namespace meshbound
