// SPDX-License-Identifier: MIT
/// Meshes and options as C callers have them.
#pragma once
#include <gtest/gtest.h>
#include <meshbound.h>

#include "meshbound/triangle_mesh.h"

namespace meshbound::test {

/// A mesh of the library as a C caller has it, which must not outlive it.
inline mb_mesh c_mesh(const TriangleMesh& mesh) {
  mb_mesh result{};
  result.positions = mesh.vertices.data();
  result.coordinate_type = MB_FLOAT64;
  result.vertex_count = mesh.vertices.size();
  result.indices = mesh.triangles.data();
  result.index_type = MB_UINT32;
  result.triangle_count = mesh.triangles.size();
  return result;
}

template <class Options>
Options defaults(mb_status (*init)(Options*, size_t)) {
  Options options;
  EXPECT_EQ(init(&options, sizeof options), MB_OK);
  return options;
}

inline mb_simplify_options simplify_options(double tolerance) {
  auto options = defaults(mb_simplify_options_init);
  options.tolerance = tolerance;
  return options;
}

/// A simplification that frees itself.
struct Simplification {
  mb_simplification* handle = nullptr;
  Simplification() = default;
  Simplification(const Simplification&) = delete;
  Simplification& operator=(const Simplification&) = delete;
  ~Simplification() { mb_simplification_free(handle); }
  [[nodiscard]] mb_level level(std::size_t index) const {
    mb_level level{};
    EXPECT_EQ(mb_simplification_level(handle, index, &level), MB_OK) << mb_error_message();
    return level;
  }
};

}  // namespace meshbound::test
