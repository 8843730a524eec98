// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/attributes.h"

namespace meshbound {

/// Throws `InvalidInput` where attributes are not those of so many triangles, or refer to values, names or parts that
/// are not there. O(n).
void check_attributes(const MeshAttributes& attributes, std::size_t triangles);

}  // namespace meshbound
