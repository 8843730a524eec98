// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::internal {

/// For tests of what stands behind proposals, and nothing else: samples may reach this multiple of what they ought to.
extern double sample_fault;

/// For tests of what stands behind proofs, and nothing else: while this is not 1, decimation proves this multiple of
/// its tolerance, and so admits what it must refuse.
extern double proof_fault;

}  // namespace meshbound::internal
