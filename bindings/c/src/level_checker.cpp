// SPDX-License-Identifier: MIT
#include "meshbound/level_checker.h"

#include <memory>

#include "arguments.h"
#include "guard.h"
#include "measurement.h"
#include "meshbound/stop_token.h"
#include "results.h"

using namespace meshbound;
using namespace meshbound::c_interface;

struct mb_level_checker {
  LevelChecker checker;
};

namespace {

mb_distance_options two_sided(const mb_distance_options* options) {
  const mb_distance_options given = complete(options, mb_distance_options_init);
  if (given.one_sided != 0) throw InvalidInput("one_sided must be 0: levels are checked both ways");
  return given;
}

}  // namespace

mb_status mb_level_checker_new(const mb_mesh* original, const mb_distance_options* options,
                               mb_level_checker** checker) {
  return guarded(threads_of(options), [&] {
    require(checker, "checker");
    const mb_distance_options given = complete(options, mb_distance_options_init);
    RunControl control(given);
    const BvhOptions tree{given.threads, {.cancel = control.flag()}};
    std::unique_ptr<mb_level_checker> built(new mb_level_checker{LevelChecker(view_of(original, "original"), tree)});
    control.finish();
    *checker = built.release();
  });
}

mb_status mb_level_checker_check(mb_level_checker* checker, const mb_mesh* level, double tolerance,
                                 const mb_distance_options* options, mb_verdict* verdict, mb_distance* distance) {
  return guarded(threads_of(options), [&] {
    require(checker, "checker");
    require(verdict, "verdict");
    const mb_distance_options given = two_sided(options);
    RunControl control(given);
    const ToleranceCheck result =
        checker->checker.check(view_of(level, "level"), tolerance, library_options(given, control));
    control.finish();
    *verdict = to_c(result.verdict);
    if (distance != nullptr) *distance = to_c(result);
  });
}

mb_status mb_level_checker_measure(mb_level_checker* checker, const mb_mesh* level, const mb_distance_options* options,
                                   mb_distance* distance) {
  return guarded(threads_of(options), [&] {
    require(checker, "checker");
    require(distance, "distance");
    const mb_distance_options given = two_sided(options);
    RunControl control(given);
    const HausdorffDistance result = checker->checker.measure(view_of(level, "level"), library_options(given, control));
    control.finish();
    *distance = to_c(result);
  });
}

void mb_level_checker_free(mb_level_checker* checker) { delete checker; }
