// SPDX-License-Identifier: MIT
#pragma once
#include <limits>
#include <string>

#include "deviation/camera.h"
#include "deviation/deviation_scale.h"
#include "deviation/picture.h"
#include "meshbound/attributes.h"
#include "meshbound/bvh.h"
#include "meshbound/deviation_map.h"
#include "meshbound/triangle_mesh.h"

namespace meshbound::tools {

/// The meshes and the scale that a picture shows.
struct DeviationScene {
  const TriangleMesh* original = nullptr;  ///< in the first panel
  const TriangleMesh* result = nullptr;    ///< in the second one
  /// Texture coordinates of both: the panels show a checkerboard there. Null: they do not.
  const CornerAttribute *original_texture = nullptr, *result_texture = nullptr;
  const TriangleMesh* coloured = nullptr;  ///< in the third one: one of both ...
  const Bvh* other = nullptr;              ///< ... in the colours of its distance from the other one
  /// An upper bound of the distance of every point of `coloured`, where it is known; model units.
  double max_deviation = std::numeric_limits<double>::infinity();
  std::string coloured_title;  ///< such as "original to result"
  std::string result_title;    ///< such as "simplified"
  std::string unit;            ///< of lengths, may be empty
  DeviationScale scale;
  UpAxis up = UpAxis::Z;
};

/// The meshes and the deviation side by side, with a scale below. The deviation is measured at the point of the surface
/// that stands at the middle of each pixel (four for each pixel of the picture), not interpolated, and what rounding
/// that point may have changed is part of its bounds. Throws `Stopped` as the options say.
[[nodiscard]] Picture deviation_image(const DeviationScene& scene, const DeviationOptions& options);

}  // namespace meshbound::tools
