// SPDX-License-Identifier: GPL-3.0-or-later
/// The drivers that this build has, for claims that must hold with each.
#pragma once
#include <memory>
#include <string>
#include <vector>

#if defined(MESHBOUND_WITH_CGAL)
#include "meshbound/cgal/edge_collapse_driver.h"
#endif
#include "meshbound/simplify.h"

namespace meshbound::test {

struct NamedDriver {
  std::string name;
  std::shared_ptr<const CollapseDriver> driver;  ///< null: our own
};

inline std::vector<NamedDriver> drivers() {
  std::vector<NamedDriver> all{{"core", nullptr}};
#if defined(MESHBOUND_WITH_CGAL)
  all.push_back({"cgal", cgal::edge_collapse_driver(cgal::CollapseCost::GarlandHeckbert)});
#endif
  return all;
}

}  // namespace meshbound::test
