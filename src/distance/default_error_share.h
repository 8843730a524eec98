// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound {

/// The default error bound of a distance, as a share of the size of the models.
inline constexpr double default_error_share = 1e-6;

}  // namespace meshbound
