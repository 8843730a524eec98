// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/attributes.h"

namespace meshbound {

/// The largest factor by which a material scales the first texture coordinates of a mesh that was read from glTF
/// (KHR_texture_transform), so that a texture has that many times its texels over a length; 1 where none does.
[[nodiscard]] double texture_scale(const MeshAttributes& attributes);

}  // namespace meshbound
