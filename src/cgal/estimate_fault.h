// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace meshbound::cgal::internal {

/// For tests of what stands behind the estimate, and nothing else: while this is not 1, the estimated phase goes on to
/// this multiple of its limit, and so to meshes that cannot be proven.
extern double estimate_fault;

}  // namespace meshbound::cgal::internal
