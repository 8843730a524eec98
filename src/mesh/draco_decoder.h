// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

namespace meshbound {

/// Whether this build decodes Draco: Google's library was found when it was configured.
[[nodiscard]] bool can_decode_draco();

/// A triangle mesh that was compressed by Draco, decoded.
class DracoMesh {
 public:
  /// Nothing where the bytes are no such mesh, are malformed, or claim to hold more triangles than bytes of that number
  /// plausibly do. Throws nothing but `std::bad_alloc`.
  [[nodiscard]] static std::optional<DracoMesh> decode(std::string_view bytes);

  [[nodiscard]] std::size_t vertex_count() const;
  [[nodiscard]] std::size_t triangle_count() const;
  /// Three indices below `vertex_count()` for each triangle.
  [[nodiscard]] std::vector<double> indices() const;
  /// The numbers of the attribute with this identifier, `width` for each vertex; normalised integers stay integers.
  /// Nothing where there is no such attribute or its elements have another width.
  [[nodiscard]] std::optional<std::vector<double>> values(std::uint32_t identifier, std::size_t width) const;

 private:
  struct Data;
  explicit DracoMesh(std::shared_ptr<const Data> data);
  std::shared_ptr<const Data> data_;
};

}  // namespace meshbound
