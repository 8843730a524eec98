// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound::internal {

/// For tests only: samples may reach this multiple of what they ought to, so that proofs must find the fault.
extern double sample_fault;

/// For tests only: decimation proves this multiple of its tolerance, so that the final measurement must find the fault.
extern double proof_fault;

}  // namespace meshbound::internal
