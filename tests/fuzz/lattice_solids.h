// SPDX-License-Identifier: MIT
/// Closed polyhedra with small integer coordinates, so that faces, edges and vertices of two of them often coincide.
#pragma once
#include <functional>

#include "reference/exact_intersection.h"

namespace meshbound::fuzz {

/// Gives a number from 0 to n - 1.
using Choose = std::function<unsigned(unsigned n)>;

/// A box, tetrahedron, wedge, L, U, ring, hollow box or pair of boxes, perhaps sheared; coordinates of at most some
/// dozen.
[[nodiscard]] reference::CellSolid lattice_solid(const Choose& choose);

}  // namespace meshbound::fuzz
