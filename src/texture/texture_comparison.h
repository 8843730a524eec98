// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <memory>

#include "meshbound/texture_deviation.h"
#include "texture/triangle_bounds.h"

namespace meshbound {

class Charts;

/// Measures the texture deviation between meshes of which each pair differs little from the one before: triangles with
/// the surroundings in the texture that they had then keep their bounds.
class TextureComparison {
 public:
  /// As `texture_deviation`, which this is for the first pair. Intervals hold as that function's do, and are no wider,
  /// but may have other ends than if the pair came first. Tolerance and error bound must be those of the first call.
  [[nodiscard]] TextureDeviation measure(std::array<TexturedMesh, 2> meshes, const TextureDeviationOptions& options);

 private:
  std::shared_ptr<const TexturedMesh> first_;  ///< of the last call; null before it
  std::shared_ptr<const Charts> charts_of_first_;
  TexturedMesh second_;                   ///< of the last call
  std::array<TriangleBounds, 2> bounds_;  ///< of A compared with B, and of B compared with A
  TextureDeviation deviation_;
};

}  // namespace meshbound
