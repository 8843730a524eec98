// SPDX-License-Identifier: GPL-3.0-or-later
// What --driver chooses from in a build with CGAL.
#include "decimation/drivers.h"
#include "meshbound/cgal/edge_collapse_driver.h"
#include "meshbound/error.h"

namespace meshbound::tools {

std::string default_driver() { return "cgal"; }

std::shared_ptr<const CollapseDriver> collapse_driver(const std::string& driver, const std::string& cost) {
  if (driver == "cgal")
    return cgal::edge_collapse_driver(cost == "lindstrom-turk" ? cgal::CollapseCost::LindstromTurk
                                                               : cgal::CollapseCost::GarlandHeckbert);
  if (cost != "garland-heckbert")
    throw InvalidInput("--cost " + cost + " needs --driver cgal: our own queue knows garland-heckbert only");
  return nullptr;
}

}  // namespace meshbound::tools
