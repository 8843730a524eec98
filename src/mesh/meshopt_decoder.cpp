// SPDX-License-Identifier: MIT
#include "mesh/meshopt_decoder.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "meshbound/triangle_mesh.h"
#include "numeric/byte_order.h"

namespace meshbound {
namespace {

constexpr std::size_t group_size = 16;           // elements that share a width of their deltas
constexpr std::size_t max_block_bytes = 8192;    // of a block of attributes, and
constexpr std::size_t max_block_elements = 256;  // elements in it
constexpr std::size_t min_attribute_tail = 32;   // bytes that the baseline element is padded to
constexpr std::size_t table_size = 16;           // bytes: the tail of a stream of triangles
constexpr std::size_t index_tail = 4;            // bytes: the tail of a stream of indices
constexpr std::size_t queue_size = 16;           // entries of the queues of edges and vertices
constexpr char attribute_header = '\xa0', triangle_header = '\xe1', index_header = '\xd1';

/// Shortest code of 64 bytes of attributes: one byte says that four groups of deltas are zero.
constexpr std::size_t max_bytes_per_code_byte = 4 * group_size;

/// Bytes that are read in order. Once they are used up, reading yields zeros and `is_valid` is false.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::uint8_t byte() {
    if (at_ == bytes_.size()) {
      is_valid_ = false;
      return 0;
    }
    return static_cast<std::uint8_t>(bytes_[at_++]);
  }

  /// An unsigned integer of 7 bits in each byte (LEB128).
  std::uint32_t varint() {
    std::uint32_t value = 0;
    for (unsigned shift = 0; shift < 35; shift += 7) {
      const std::uint8_t next = byte();
      value |= static_cast<std::uint32_t>(next & 0x7fU) << shift;
      if (next < 0x80) return value;
    }
    is_valid_ = false;
    return 0;
  }

  [[nodiscard]] bool is_valid() const { return is_valid_; }
  [[nodiscard]] bool is_at_end() const { return is_valid_ && at_ == bytes_.size(); }

 private:
  std::string_view bytes_;
  std::size_t at_ = 0;
  bool is_valid_ = true;
};

/// The signed difference that an unsigned integer stands for: 0, -1, 1, -2, ...
template <class T>
T unfolded(T v) {
  return static_cast<T>((v & 1) != 0 ? ~(v >> 1) : v >> 1);
}

/// The folded deltas of a group, each of `bits` bits, where a number of ones only says that a whole byte follows.
void read_deltas(ByteReader& data, unsigned bits, std::array<std::uint8_t, group_size>& deltas) {
  const auto sentinel = static_cast<std::uint8_t>((1U << bits) - 1);
  for (std::size_t i = 0; i < group_size;) {
    const unsigned packed = data.byte();
    for (unsigned shift = 8; shift > 0; ++i) {
      shift -= bits;
      deltas[i] = static_cast<std::uint8_t>((packed >> shift) & sentinel);
    }
  }
  for (std::uint8_t& delta : deltas)
    if (delta == sentinel) delta = data.byte();
}

void read_group(ByteReader& data, unsigned mode, std::array<std::uint8_t, group_size>& deltas) {
  if (mode == 0)
    deltas.fill(0);
  else if (mode == 3)
    for (std::uint8_t& delta : deltas) delta = data.byte();
  else
    read_deltas(data, 2 * mode, deltas);
}

/// One byte of each of `count` elements, `stride` bytes apart from `to` on; `last` is that byte of the element before.
void read_byte_plane(ByteReader& data, std::size_t count, std::size_t stride, char* to, std::uint8_t last) {
  const std::size_t groups = (count + group_size - 1) / group_size;
  std::vector<std::uint8_t> modes((groups + 3) / 4);
  for (std::uint8_t& byte : modes) byte = data.byte();
  std::array<std::uint8_t, group_size> deltas;
  for (std::size_t g = 0; g < groups; ++g) {
    read_group(data, (modes[g / 4] >> (2 * (g % 4))) & 3U, deltas);
    for (std::size_t i = 0; i < std::min(group_size, count - g * group_size); ++i, to += stride) {
      last = static_cast<std::uint8_t>(last + unfolded(deltas[i]));
      *to = static_cast<char>(last);
    }
  }
}

void append_index(std::string& to, std::uint32_t index, std::size_t stride) {
  for (std::size_t k = 0; k < stride; ++k) to += static_cast<char>((index >> (8 * k)) & 0xffU);
}

/// The latest entries that were pushed, the newest at 0; zeros before the first.
template <class T>
class RecentQueue {
 public:
  void push(const T& entry) { entries_[next_++ % queue_size] = entry; }
  [[nodiscard]] const T& at(std::size_t age) const { return entries_[(next_ - 1 - age) % queue_size]; }

 private:
  std::array<T, queue_size> entries_{};
  std::size_t next_ = queue_size;  // a multiple, so that ages never reach below 0
};

class TriangleDecoder {
 public:
  TriangleDecoder(std::string_view data, std::string_view table) : data_(data), table_(table) {}

  Triangle triangle(std::uint8_t code) {
    const unsigned high = code >> 4U, low = code & 0xfU;
    if (high < 0xf) return beside_recent_edge(high, low);
    return low < 0xe ? from_table(low) : written_out(low == 0xe);
  }
  [[nodiscard]] bool is_at_end() const { return data_.is_at_end(); }

 private:
  using Edge = std::array<std::uint32_t, 2>;

  Triangle beside_recent_edge(unsigned edge, unsigned vertex) {
    const auto [a, b] = edges_.at(edge);
    std::uint32_t c = 0;
    if (vertex == 0)
      c = next_++;
    else if (vertex < 0xd)
      c = vertices_.at(vertex);
    else if (vertex < 0xf)
      c = last_ = vertex == 0xd ? last_ - 1 : last_ + 1;
    else
      c = read_index();
    edges_.push({c, b});
    edges_.push({a, c});
    if (vertex == 0 || vertex >= 0xd) vertices_.push(c);
    return {a, b, c};
  }

  Triangle from_table(unsigned entry) {
    const auto choices = static_cast<std::uint8_t>(table_[entry]);
    const std::uint32_t a = next_++;
    return finish(a, choices >> 4U, choices & 0xfU);
  }

  Triangle written_out(bool starts_with_next) {
    const std::uint8_t choices = data_.byte();
    if (choices == 0) next_ = 0;
    const std::uint32_t a = starts_with_next ? next_++ : read_index();
    return finish(a, choices >> 4U, choices & 0xfU);
  }

  /// The triangle with first corner `a` whose others are chosen by four bits each.
  Triangle finish(std::uint32_t a, unsigned choice_b, unsigned choice_c) {
    const std::uint32_t b = chosen(choice_b), c = chosen(choice_c);
    edges_.push({b, a});
    edges_.push({c, b});
    edges_.push({a, c});
    vertices_.push(a);
    if (is_new(choice_b)) vertices_.push(b);
    if (is_new(choice_c)) vertices_.push(c);
    return {a, b, c};
  }

  static bool is_new(unsigned choice) { return choice == 0 || choice == 0xf; }
  std::uint32_t chosen(unsigned choice) {
    if (choice == 0) return next_++;
    return choice == 0xf ? read_index() : vertices_.at(choice - 1);
  }
  std::uint32_t read_index() { return last_ += unfolded(data_.varint()); }

  ByteReader data_;
  std::string_view table_;
  RecentQueue<Edge> edges_;
  RecentQueue<std::uint32_t> vertices_;
  std::uint32_t next_ = 0, last_ = 0;
};

template <class T>
T integer_at(const char* at) {
  return load_number<T>(at, std::endian::little);
}

template <class T>
void put_integer(char* at, T value) {
  store_number(value, at, std::endian::little);
}

/// The nearest integer to a number from -1 to 1 times the largest integer; 0 where it is none, which only malformed
/// elements lead to.
template <class T>
T normalized_integer(float number) {
  const float max = std::numeric_limits<T>::max();
  return std::isfinite(number) ? static_cast<T>(std::round(std::clamp(number, -1.0F, 1.0F) * max)) : T{0};
}

template <class T>
void unfold_octahedron(char* element) {
  const auto one = static_cast<float>(integer_at<T>(element + 2 * sizeof(T)));
  float x = static_cast<float>(integer_at<T>(element)) / one;
  float y = static_cast<float>(integer_at<T>(element + sizeof(T))) / one;
  const float z = 1 - std::abs(x) - std::abs(y), below = std::min(z, 0.0F);
  x -= std::copysign(below, x);
  y -= std::copysign(below, y);
  const float length = std::sqrt(x * x + y * y + z * z);
  put_integer(element, normalized_integer<T>(x / length));
  put_integer(element + sizeof(T), normalized_integer<T>(y / length));
  put_integer(element + 2 * sizeof(T), normalized_integer<T>(z / length));
}

}  // namespace

std::optional<std::string> decode_meshopt_attributes(std::string_view stream, std::size_t count, std::size_t stride) {
  const std::size_t tail = std::max(stride, min_attribute_tail);
  if (stream.size() < 1 + tail || stream[0] != attribute_header) return std::nullopt;
  if (count / max_bytes_per_code_byte > stream.size() / stride) return std::nullopt;
  std::string elements(count * stride, '\0');
  const std::string_view baseline = stream.substr(stream.size() - stride);
  ByteReader data(stream.substr(1, stream.size() - 1 - tail));
  const std::size_t block = std::min(max_block_bytes / stride / group_size * group_size, max_block_elements);
  for (std::size_t first = 0; first < count && data.is_valid(); first += block) {
    char* const to = elements.data() + first * stride;
    for (std::size_t k = 0; k < stride; ++k) {
      const char last =
          first == 0 ? baseline[k] : to[static_cast<std::ptrdiff_t>(k) - static_cast<std::ptrdiff_t>(stride)];
      read_byte_plane(data, std::min(block, count - first), stride, to + k, static_cast<std::uint8_t>(last));
    }
  }
  if (!data.is_at_end()) return std::nullopt;
  return elements;
}

std::optional<std::string> decode_meshopt_triangles(std::string_view stream, std::size_t count, std::size_t stride) {
  const std::size_t triangles = count / 3;
  if (stream.size() < 1 + table_size || stream[0] != triangle_header) return std::nullopt;
  if (triangles > stream.size() - 1 - table_size) return std::nullopt;
  const std::string_view codes = stream.substr(1, triangles);
  TriangleDecoder decoder(stream.substr(1 + triangles, stream.size() - 1 - triangles - table_size),
                          stream.substr(stream.size() - table_size));
  std::string indices;
  indices.reserve(count * stride);
  for (const char code : codes)
    for (const std::uint32_t index : decoder.triangle(static_cast<std::uint8_t>(code)))
      append_index(indices, index, stride);
  if (!decoder.is_at_end()) return std::nullopt;
  return indices;
}

std::optional<std::string> decode_meshopt_indices(std::string_view stream, std::size_t count, std::size_t stride) {
  if (stream.size() < 1 + index_tail || stream[0] != index_header) return std::nullopt;
  if (count > stream.size() - 1 - index_tail) return std::nullopt;
  ByteReader data(stream.substr(1, stream.size() - 1 - index_tail));
  std::array<std::uint32_t, 2> last{};
  std::string indices;
  indices.reserve(count * stride);
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t code = data.varint();
    std::uint32_t& baseline = last[code & 1U];
    baseline += unfolded(code >> 1U);
    append_index(indices, baseline, stride);
  }
  if (!data.is_at_end()) return std::nullopt;
  return indices;
}

void apply_octahedral_filter(std::string& elements, std::size_t stride) {
  for (std::size_t i = 0; i + stride <= elements.size(); i += stride)
    stride == 4 ? unfold_octahedron<std::int8_t>(elements.data() + i)
                : unfold_octahedron<std::int16_t>(elements.data() + i);
}

void apply_quaternion_filter(std::string& elements) {
  using Component = std::int16_t;
  constexpr std::size_t stride = 4 * sizeof(Component);
  const float range = 1 / std::sqrt(2.0F);
  for (std::size_t i = 0; i + stride <= elements.size(); i += stride) {
    char* const element = elements.data() + i;
    const auto last = integer_at<Component>(element + 3 * sizeof(Component));
    const auto one = static_cast<float>(last | 3);
    std::array<float, 4> q{};  // the largest component first
    float rest = 1;
    for (std::size_t k = 0; k < 3; ++k) {
      q[k + 1] = static_cast<float>(integer_at<Component>(element + k * sizeof(Component))) / one * range;
      rest -= q[k + 1] * q[k + 1];
    }
    q[0] = std::sqrt(std::max(0.0F, rest));
    const auto largest = static_cast<std::size_t>(last & 3);
    for (std::size_t k = 0; k < 4; ++k)
      put_integer(element + (largest + k) % 4 * sizeof(Component), normalized_integer<Component>(q[k]));
  }
}

void apply_exponential_filter(std::string& elements) {
  constexpr std::uint32_t sign_of_mantissa = 1U << 23U;
  for (std::size_t i = 0; i + 4 <= elements.size(); i += 4) {
    const auto packed = integer_at<std::uint32_t>(elements.data() + i);
    const int exponent = static_cast<std::int8_t>(packed >> 24U);
    const std::uint32_t low = packed & 0xffffffU;
    const int mantissa = static_cast<int>(low) - ((low & sign_of_mantissa) != 0 ? 1 << 24 : 0);
    put_integer(elements.data() + i, std::bit_cast<std::uint32_t>(std::ldexp(static_cast<float>(mantissa), exponent)));
  }
}

}  // namespace meshbound
