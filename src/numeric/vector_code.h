// SPDX-License-Identifier: MIT
#pragma once

namespace meshbound {

/// Whether kernels that were compiled for AVX2 are used: the compiler and the processor know it, and no test forbids
/// it.
[[nodiscard]] bool uses_avx2();

namespace internal {

/// For tests that compare whole runs, and nothing else: true leaves portable kernels only. Kernels that were chosen
/// before stay.
extern bool portable_kernels;

}  // namespace internal
}  // namespace meshbound
