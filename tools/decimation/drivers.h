// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>

#include "meshbound/simplify.h"

namespace meshbound::tools {

/// The value of --driver where none is given: "cgal" where CGAL is built, else "core".
[[nodiscard]] std::string default_driver();

/// The driver of this name, null for our own, "core", whose cost is that of Garland and Heckbert. Throws `InvalidInput`
/// for "cgal" where CGAL is not built, and where the driver does not know the cost.
[[nodiscard]] std::shared_ptr<const CollapseDriver> collapse_driver(const std::string& driver, const std::string& cost);

}  // namespace meshbound::tools
