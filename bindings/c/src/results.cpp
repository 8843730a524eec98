// SPDX-License-Identifier: MIT
#include "results.h"

#include "meshbound/report.h"

namespace meshbound::c_interface {
namespace {

mb_outcome c_outcome(Outcome outcome) {
  switch (outcome) {
    case Outcome::Converged:
      return MB_CONVERGED;
    case Outcome::ExceedsTolerance:
      return MB_EXCEEDS_TOLERANCE;
    case Outcome::BudgetExhausted:
      return MB_TIME_LIMIT;
    case Outcome::PrecisionReached:
      break;
  }
  return MB_PRECISION;
}

mb_surface_point c_point(const SurfacePoint& point) {
  return {{point.position.x(), point.position.y(), point.position.z()}, point.triangle};
}

mb_direction c_direction(const OneSidedDistance& direction) {
  mb_direction result{};
  result.bounds = to_c(direction.bounds);
  result.from = c_point(direction.witness.from);
  result.nearest = c_point(direction.witness.nearest);
  result.outcome = was_searched(direction) ? c_outcome(direction.outcome) : MB_NOT_SEARCHED;
  return result;
}

}  // namespace

mb_bounds to_c(const Bounds& bounds) { return {bounds.lower, bounds.upper}; }

mb_verdict to_c(Verdict verdict) {
  switch (verdict) {
    case Verdict::Within:
      return MB_WITHIN;
    case Verdict::Exceeds:
      return MB_EXCEEDS;
    case Verdict::Undecided:
      break;
  }
  return MB_UNDECIDED;
}

mb_distance to_c(const HausdorffDistance& distance) {
  return {to_c(distance.bounds), c_direction(distance.a_to_b), c_direction(distance.b_to_a)};
}

mb_distance to_c(const ToleranceCheck& check) {
  return {to_c(check.bounds), c_direction(check.a_to_b), c_direction(check.b_to_a)};
}

mb_ended_by to_c(EndedBy reason) {
  switch (reason) {
    case EndedBy::Target:
      return MB_ENDED_TARGET;
    case EndedBy::Tolerance:
      return MB_ENDED_TOLERANCE;
    case EndedBy::TimeLimit:
      return MB_ENDED_TIME_LIMIT;
    case EndedBy::Rounding:
      return MB_ENDED_ROUNDING;
    case EndedBy::NothingFits:
    case EndedBy::Cancelled:
      break;
  }
  return MB_ENDED_NOTHING_FITS;
}

}  // namespace meshbound::c_interface
