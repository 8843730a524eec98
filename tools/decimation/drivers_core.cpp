// SPDX-License-Identifier: MIT
// What --driver chooses from in a build without CGAL.
#include "decimation/drivers.h"
#include "meshbound/error.h"

namespace meshbound::tools {

std::string default_driver() { return "core"; }

std::shared_ptr<const CollapseDriver> collapse_driver(const std::string& driver, const std::string& cost) {
  if (driver == "cgal") throw InvalidInput("--driver cgal: this program was built without CGAL; use --driver core");
  if (cost != "garland-heckbert")
    throw InvalidInput("--cost " + cost + " needs --driver cgal, and this program was built without CGAL");
  return nullptr;
}

}  // namespace meshbound::tools
