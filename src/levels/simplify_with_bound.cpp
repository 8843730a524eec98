// SPDX-License-Identifier: MIT
#include "levels/level_run.h"
#include "levels/measured_level.h"
#include "meshbound/simplify.h"

namespace meshbound {

std::string to_string(EndedBy reason) {
  switch (reason) {
    case EndedBy::NothingFits:
    case EndedBy::Tolerance:
      return "tolerance";
    case EndedBy::Target:
      return "target";
    case EndedBy::Rounding:
      return "rounding";
    case EndedBy::TimeLimit:
      return "time_limit";
    case EndedBy::Cancelled:
      break;
  }
  return "cancelled";
}

CollapseCounts& CollapseCounts::operator+=(const CollapseCounts& other) {
  tried += other.tried;
  refused += other.refused;
  proven_together += other.proven_together;
  taken_back += other.taken_back;
  proven_alone += other.proven_alone;
  restored += other.restored;
  unproven += other.unproven;
  originals_tested += other.originals_tested;
  faces_tested += other.faces_tested;
  return *this;
}

SimplifyResult simplify_with_bound(const TriangleMesh& original, const SimplifyOptions& options) {
  SimplifyResult result = decimate_levels(original, options);
  const auto measuring = LevelRun::Clock::now();
  const Bvh tree(original, BvhOptions{options.threads});
  for (SimplifiedLevel& level : result.levels) measure_level(original, tree, result.lines, level, options);
  result.seconds.measure = seconds_since(measuring);
  return result;
}

}  // namespace meshbound
