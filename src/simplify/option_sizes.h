// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

#include "meshbound/simplify.h"

namespace meshbound {

/// Throws `InvalidInput` where an option that is given by vertex, edge or triangle does not fit a mesh of so many.
void check_sizes(const SimplifyOptions& options, std::size_t vertices, std::size_t triangles);

}  // namespace meshbound
