// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "mesh/gltf_document.h"

namespace meshbound {

/// The bytes of an element of a vertex, `size` rounded up to what glTF aligns elements to.
[[nodiscard]] std::size_t padded_to_alignment(std::size_t size);

/// The elements of an accessor, `numbers.width` of the values each, `stride` bytes apart. Integers are rounded and
/// clamped; normalised ones from the number that they stand for.
[[nodiscard]] std::string packed_elements(const GltfNumbers& numbers, const std::vector<double>& values,
                                          std::size_t stride);

/// The accessors, buffer views and bytes of a glTF file that is written. Entries that stay keep their numbers, so that
/// references to them remain valid, also those in extensions that are unknown here. New entries take freed numbers
/// first.
class GltfBuffer {
 public:
  /// `json` is changed in place and must outlive this; `buffers` are the bytes it refers to.
  GltfBuffer(GltfJson& json, const std::vector<std::string>& buffers);

  /// Frees accessors that nothing refers to any more, and the buffer views that only they used. Call at most once,
  /// before anything is added.
  void free_accessors(const std::vector<std::size_t>& accessors);

  /// Adds an accessor of `values`, `numbers.width` for each element, and returns its number. Integers are rounded and
  /// clamped. `with_range` writes "min" and "max", which accessors of positions must have.
  std::size_t add_accessor(const GltfNumbers& numbers, const std::vector<double>& values, bool with_range);
  /// Adds the accessor of the corners of triangles and returns its number; 16-bit integers where these suffice.
  std::size_t add_indices(const std::vector<Triangle>& triangles, std::size_t vertices);
  /// Adds bytes as a buffer view, and returns its number.
  std::size_t add_view(std::string_view bytes, std::size_t stride, int target);

  /// Copies the old buffer views that are left behind the new ones and returns the bytes of the single buffer. Call
  /// last. Throws `InvalidInput` for a view that reaches beyond its buffer.
  [[nodiscard]] std::string finish();

 private:
  std::size_t add_item(const char* key, GltfJson item, std::vector<std::size_t>& free);
  void fill_free_places();
  void move_old_view(GltfJson& view, std::size_t number);

  GltfJson& json_;
  const std::vector<std::string>& old_;
  std::string bytes_;
  std::vector<std::size_t> free_accessors_, free_views_;  ///< descending: numbers are taken from the end
  std::vector<std::size_t> new_views_;
};

}  // namespace meshbound
