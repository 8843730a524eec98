// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <utility>

#include "meshbound/simplify.h"

namespace meshbound::test {

/// Options of a simplification on one thread, by our own queue where no driver is given.
inline SimplifyOptions within(double tolerance, std::shared_ptr<const CollapseDriver> driver = nullptr) {
  SimplifyOptions options;
  options.tolerance = tolerance;
  options.threads = 1;
  options.driver = std::move(driver);
  return options;
}

}  // namespace meshbound::test
