// SPDX-License-Identifier: MIT
#pragma once
#include "meshbound/stop_token.h"
#include "simplify/propose.h"
#include "simplify/prove.h"

namespace meshbound {

struct DecimationGoal {
  double tolerance = 0;
  std::size_t target_faces = 0;
  StopToken stop;
};

void decimate(DecimationState& state, const DecimationGoal& goal, int threads);

}  // namespace meshbound
